// The programs that draw boxes: an instance each, so 100,000 boxes are one call.

/** Flat boxes: a rectangle with a border of a pixel or so. */
export const flatVertex = `#version 300 es
in vec2 corner;
in vec4 box;
in float mark;
uniform mat4 matrix;
uniform vec2 pixels;
uniform float least;
uniform vec4 inks[6];
uniform float fills[6];
uniform float only;
out vec2 at;
out vec2 size;
flat out vec4 ink;
flat out float fill;
void main() {
  int kind = only >= 0.0 ? int(only) : int(mark + 0.5);
  ink = inks[kind];
  fill = fills[kind];
  vec2 low = (matrix * vec4(box.xy, 0.0, 1.0)).xy;
  vec2 high = (matrix * vec4(box.zw, 0.0, 1.0)).xy;
  // A border beyond the picture need not be exact, and infinity is no place.
  low = clamp(low, -4.0, 4.0);
  high = clamp(high, -4.0, 4.0);
  // y grows downwards in the world, and upwards here.
  vec2 bottom = min(low, high);
  high = max(low, high);
  low = bottom;
  vec2 middle = 0.5 * (low + high);
  vec2 extent = max(0.5 * (high - low), least / pixels);
  // A box over all of the picture leaves the others their colours.
  if (extent.x * extent.y > 0.5) fill *= 0.3;
  size = extent * pixels;
  at = (corner * 2.0 - 1.0) * size;
  bool absent = box.x > box.z;
  gl_Position = absent ? vec4(9.0, 9.0, 9.0, 1.0) : vec4(middle + (corner * 2.0 - 1.0) * extent, 0.0, 1.0);
}`;

export const flatFragment = `#version 300 es
precision highp float;
in vec2 at;
in vec2 size;
flat in vec4 ink;
flat in float fill;
uniform float border;
out vec4 colour;
void main() {
  vec2 inside = size - abs(at);
  float edge = min(inside.x, inside.y) < border ? 1.0 : fill;
  colour = vec4(ink.rgb, 1.0) * (edge * ink.a);
}`;

/** Boxes in 3D: their faces, translucent, or their edges. */
export const solidVertex = `#version 300 es
in vec3 corner;
in vec3 low;
in vec3 high;
in float mark;
uniform mat4 matrix;
uniform vec4 inks[6];
uniform float fills[6];
uniform float only;
uniform float faces;
flat out vec4 ink;
void main() {
  int kind = only >= 0.0 ? int(only) : int(mark + 0.5);
  float strength = faces > 0.5 ? fills[kind] * 0.45 : 0.85;
  ink = vec4(inks[kind].rgb, 1.0) * (inks[kind].a * strength);
  vec3 place = clamp(mix(low, high, corner), -1e6, 1e6);
  gl_Position = low.x > high.x ? vec4(9.0, 9.0, 9.0, 1.0) : matrix * vec4(place, 1.0);
}`;

export const solidFragment = `#version 300 es
precision highp float;
flat in vec4 ink;
out vec4 colour;
void main() { colour = ink; }`;

/** Lines between points, in one colour. */
export const lineVertex = `#version 300 es
in vec3 point;
uniform mat4 matrix;
void main() { gl_Position = matrix * vec4(point, 1.0); }`;

export const lineFragment = `#version 300 es
precision highp float;
uniform vec4 ink;
out vec4 colour;
void main() { colour = ink; }`;
