// Records some seconds as a GIF: small, in at most 256 colours.
import { applyPalette, GIFEncoder, quantize } from "gifenc";

const width = 480;
const framesPerSecond = 12;

export async function gifOf(canvas: HTMLCanvasElement, seconds: number): Promise<Blob> {
  const height = Math.max(1, Math.round(canvas.height * width / canvas.width));
  const picture = document.createElement("canvas");
  picture.width = width;
  picture.height = height;
  const context = picture.getContext("2d", { willReadFrequently: true })!;
  const encoder = GIFEncoder();
  for (let frame = 0; frame < seconds * framesPerSecond; ++frame) {
    context.drawImage(canvas, 0, 0, width, height);
    const { data } = context.getImageData(0, 0, width, height);
    const colours = quantize(data, 128);
    encoder.writeFrame(applyPalette(data, colours), width, height, { palette: colours, delay: 1000 / framesPerSecond });
    await new Promise((resolve) => setTimeout(resolve, 1000 / framesPerSecond));
  }
  encoder.finish();
  return new Blob([encoder.bytes() as Uint8Array<ArrayBuffer>], { type: "image/gif" });
}
