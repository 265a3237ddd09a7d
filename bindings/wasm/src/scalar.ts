// The module without SIMD, in a file of its own, for it is rarely needed.
export { bytes } from "wasm:broadside-scalar";
