// Its module without SIMD, likewise.
export { bytes } from "wasm:broadside-pairs-scalar";
