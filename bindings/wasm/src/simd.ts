// Whether WebAssembly has SIMD here.

/** A module of one function, which makes a vector and counts its bits. */
const moduleWithSimd = new Uint8Array([
  0, 0x61, 0x73, 0x6d, 1, 0, 0, 0,           // "\0asm", version 1
  1, 5, 1, 0x60, 0, 1, 0x7b,                 // one type: () -> v128
  3, 2, 1, 0,                                // one function of it:
  10, 10, 1, 8, 0, 0x41, 0, 0xfd, 15, 0xfd, 98, 11,  // i32.const 0, i8x16.splat, i8x16.popcnt
]);

export function supportsSimd(): boolean {
  return WebAssembly.validate(moduleWithSimd);
}
