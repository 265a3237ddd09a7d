// What a module takes of JavaScript. It asks for a clock, files and the like where the standard library might want them,
// which no call comes to.

/** Called where C++ gives up, which it does only if an exception leaves a destructor. */
function ended(code: number): never {
  throw new Error(`the module ended with ${code}`);
}

export function importsOf(module: WebAssembly.Module): WebAssembly.Imports {
  const imports: WebAssembly.Imports = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module))
    (imports[from] ??= {})[name] = name === "proc_exit" ? ended : (): number => 0;
  return imports;
}
