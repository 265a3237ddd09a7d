// A scene of recorded frames, such as a file's.
import { numbersPerBox, usualBounds, type Dimension, type Scene } from "./scene.ts";

export const framesPerSecond = 20;

/** Frames of boxes. Frames may differ in the number of boxes; missing ones are absent. */
export interface Recorded {
  dimension: Dimension;
  frames: Float32Array<ArrayBuffer>[];
}

export function recordedScene({ dimension, frames }: Recorded): Scene {
  const stride = numbersPerBox(dimension);
  const maxLength = Math.max(0, ...frames.map((frame) => frame.length));
  const absent = [...Array<number>(dimension).fill(Infinity), ...Array<number>(dimension).fill(-Infinity)];
  return {
    dimension,
    bounds: usualBounds(frames[0] ?? new Float32Array(), dimension),
    duration: frames.length / framesPerSecond,
    at(time) {
      const frame = frames[Math.floor(time * framesPerSecond + 1e-6) % frames.length];
      const boxes = new Float32Array(maxLength);
      if (frame !== undefined) boxes.set(frame);
      for (let at = frame?.length ?? 0; at < maxLength; at += stride) boxes.set(absent, at);
      return boxes;
    },
  };
}
