// Shaders for boxes. They read boxes from textures by vertex number, so that all boxes of a picture
// are drawn in one or two calls. One instance per box would be simpler, but some drivers draw
// instances one by one.
import { rowTexels } from "./batch.ts";

const fetchBox = `
uniform highp sampler2D boxes;
uniform highp usampler2D marks;
uniform int dimension;
uniform int first;
uniform vec4 inks[6];
uniform float fills[6];
ivec2 texel(int at) { return ivec2(at & ${rowTexels - 1}, at >> ${Math.log2(rowTexels)}); }
void fetchBox(int box, out vec3 low, out vec3 high, out int mark) {
  int at = dimension * box;
  vec2 a = texelFetch(boxes, texel(at), 0).xy;
  vec2 b = texelFetch(boxes, texel(at + 1), 0).xy;
  if (dimension == 2) {
    low = vec3(a, 0.0);
    high = vec3(b, 0.0);
  } else {
    low = vec3(a, b.x);
    high = vec3(b.y, texelFetch(boxes, texel(at + 2), 0).xy);
  }
  mark = int(texelFetch(marks, texel(box), 0).x);
}
`;

/**
 * Boxes as rectangles with a border of about a pixel, four vertices each; tiny boxes, also in 3D,
 * as points.
 */
export const flatVertex = `#version 300 es
${fetchBox}
uniform mat4 matrix;
uniform vec4 viewport;
uniform float minExtent;
uniform bool points;
flat out vec4 place;
flat out vec4 ink;
flat out float fill;
void main() {
  vec3 low, high;
  int mark;
  fetchBox(first + (points ? gl_VertexID : gl_VertexID >> 2), low, high, mark);
  ink = vec4(inks[mark].rgb, 1.0) * inks[mark].a;
  fill = fills[mark];
  vec2 pixels = 0.5 * viewport.zw;
  vec2 middle, extent;
  if (dimension == 2) {
    vec2 a = (matrix * vec4(low.xy, 0.0, 1.0)).xy;
    vec2 b = (matrix * vec4(high.xy, 0.0, 1.0)).xy;
    middle = 0.5 * (a + b);
    extent = 0.5 * abs(b - a);
  } else {
    vec4 centre = matrix * vec4(0.5 * (low + high), 1.0);
    mat3 turn = mat3(matrix);
    middle = centre.xy / centre.w;
    extent = (0.5 * (mat3(abs(turn[0]), abs(turn[1]), abs(turn[2])) * (high - low)) / centre.w).xy;
  }
  extent = max(extent, minExtent / pixels);
  // A box over all of the picture leaves the others their colours.
  if (extent.x * extent.y > 0.5) fill *= 0.3;
  place = vec4(viewport.xy + (middle + 1.0) * pixels, extent * pixels);
  // What has a part of a pixel is drawn in it, so half a pixel more on each side.
  gl_PointSize = 2.0 * max(place.z, place.w) + 1.0;
  vec2 corner = points ? vec2(0.0) : vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
  gl_Position = vec4(middle + corner * (extent + 0.5 / pixels), 0.0, 1.0);
}`;

/**
 * Each pixel by how much of it the box and its inside cover, as multisampling would estimate it.
 */
export const flatFragment = `#version 300 es
precision highp float;
flat in vec4 place;
flat in vec4 ink;
flat in float fill;
uniform float border;
out vec4 colour;
float covered(vec2 away, vec2 extent) {
  vec2 part = clamp(min(away + 0.5, extent) - max(away - 0.5, -extent), 0.0, 1.0);
  return part.x * part.y;
}
void main() {
  vec2 away = gl_FragCoord.xy - place.xy;
  colour = ink * (covered(away, place.zw) - (1.0 - fill) * covered(away, place.zw - border));
}`;

/** Boxes in 3D: translucent faces, or edges; eight vertices each. */
export const solidVertex = `#version 300 es
${fetchBox}
uniform mat4 matrix;
uniform bool faces;
flat out vec4 ink;
void main() {
  vec3 low, high;
  int mark;
  fetchBox(first + (gl_VertexID >> 3), low, high, mark);
  ink = vec4(inks[mark].rgb, 1.0) * (inks[mark].a * (faces ? fills[mark] * 0.45 : 0.85));
  vec3 corner = vec3(gl_VertexID & 1, (gl_VertexID >> 1) & 1, (gl_VertexID >> 2) & 1);
  gl_Position = matrix * vec4(mix(low, high, corner), 1.0);
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
