// Makes the paper: node main.mjs [--check] EXPERIMENTS COMPARISON TEMPLATES FOLDER.
import { argv, exit, stderr, stdout } from "node:process";

import { run } from "./program.ts";

exit(run(argv.slice(2), { out: (text) => stdout.write(text), error: (text) => stderr.write(text) }));
