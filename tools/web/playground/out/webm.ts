// Records some seconds as a film, with the browser's own encoder.

export async function webmOf(canvas: HTMLCanvasElement, seconds: number): Promise<Blob> {
  if (typeof MediaRecorder === "undefined" || !MediaRecorder.isTypeSupported("video/webm"))
    throw new Error("this browser makes no WebM; save a GIF instead");
  const recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: "video/webm", videoBitsPerSecond: 6e6 });
  const parts: Blob[] = [];
  recorder.ondataavailable = ({ data }) => void parts.push(data);
  const ended = new Promise<void>((resolve) => { recorder.onstop = () => resolve(); });
  recorder.start();
  await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
  recorder.stop();
  await ended;
  return new Blob(parts, { type: "video/webm" });
}
