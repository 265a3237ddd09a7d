// The panels as a PNG, each under its caption; and an SVG as a PNG.
import type { Stage } from "../ui/stage.ts";
import { palette } from "../ui/themes.ts";

export async function pngOf(stage: Stage, captions: readonly string[]): Promise<Blob> {
  stage.paint();
  const picture = document.createElement("canvas");
  picture.width = stage.canvas.width;
  picture.height = stage.canvas.height;
  const context = picture.getContext("2d")!;
  context.drawImage(stage.canvas, 0, 0);
  const ratio = stage.canvas.width / stage.canvas.clientWidth;
  context.scale(ratio, ratio);
  context.font = "13px system-ui, sans-serif";
  context.fillStyle = palette.value.text;
  captions.forEach((caption, at) => {
    const place = stage.place(at);
    if (place !== undefined) context.fillText(caption, place.x + 8, place.y - 10);
  });
  return await blobOf(picture);
}

function blobOf(picture: HTMLCanvasElement): Promise<Blob> {
  return new Promise((resolve, reject) => picture.toBlob((blob) =>
    blob === null ? reject(new Error("the browser made no PNG")) : resolve(blob), "image/png"));
}

/** With two pixels for one of the SVG's, as documents need. */
export async function pngOfSvg(svg: string): Promise<Blob> {
  const image = new Image();
  image.src = `data:image/svg+xml,${encodeURIComponent(svg)}`;
  await image.decode();
  const picture = document.createElement("canvas");
  [picture.width, picture.height] = [2 * image.naturalWidth, 2 * image.naturalHeight];
  picture.getContext("2d")!.drawImage(image, 0, 0, picture.width, picture.height);
  return await blobOf(picture);
}
