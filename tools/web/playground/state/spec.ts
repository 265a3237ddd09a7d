// Splits and joins specs such as "grid:cell=4:update=follow".

export function nameOf(spec: string): string {
  return spec.split(":", 1)[0] ?? spec;
}

export function settingsOf(spec: string): Map<string, string> {
  const at = spec.indexOf(":");
  if (at < 0) return new Map();
  return new Map(spec.slice(at + 1).split(":").filter((one) => one !== "").map((one) => {
    const equals = one.indexOf("=");
    return equals < 0 ? [one, ""] as const : [one.slice(0, equals), one.slice(equals + 1)] as const;
  }));
}

/** The spec with a setting changed; undefined removes it. */
export function withSetting(spec: string, name: string, value: string | undefined): string {
  const settings = settingsOf(spec);
  if (value === undefined) settings.delete(name);
  else settings.set(name, value);
  const list = [...settings].map(([key, one]) => one === "" ? key : `${key}=${one}`);
  return nameOf(spec) + (list.length > 0 ? `:${list.join(":")}` : "");
}
