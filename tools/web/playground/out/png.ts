// The panels as a PNG, each under its caption.
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
  return await new Promise((resolve, reject) => picture.toBlob((blob) =>
    blob === null ? reject(new Error("the browser made no PNG")) : resolve(blob), "image/png"));
}
