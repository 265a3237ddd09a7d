// Entry point of the worker. It is built as the body of a function `(self) => ...`.
import { serve, type Port } from "./serve.ts";

serve(self as unknown as Port);
