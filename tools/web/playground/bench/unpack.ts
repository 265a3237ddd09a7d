// The engine's modules as the page embeds them: compressed, as text, so that they need no request
// and little room.

/** Decodes a text in base64 that was compressed by gzip. */
export async function unpack(text: string): Promise<Uint8Array<ArrayBuffer>> {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  if (typeof DecompressionStream === "undefined")
    throw new Error("this browser cannot decompress gzip (it has no DecompressionStream), so the engine does not start");
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
