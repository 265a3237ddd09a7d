// Fuzzes the reader of snapshots: whatever the bytes, a world restores or refuses them; and one that it has
// restored lives on as any other, and so does its own snapshot.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/recorder.hpp"
#include "broadside/world.hpp"

namespace broadside {
namespace {

using Bytes = std::vector<std::byte>;

/// Ends the program, which is how a fuzzer learns of a fault.
void expect(bool holds) {
  if (!holds) std::abort();
}

template <int D, typename Real>
Box<D, Real> unit_box() {
  Box<D, Real> box;
  box.min.fill(0);
  box.max.fill(1);
  return box;
}

template <int D, typename Real>
void check_lives_on(World<D, Real>& world) {
  const Bytes bytes = world.snapshot();
  World<D, Real> other;
  other.restore(bytes);
  expect(other.snapshot() == bytes);
  for (int frame = 0; frame < 3; ++frame) {
    const Handle here = world.add(unit_box<D, Real>());
    expect(other.add(unit_box<D, Real>()) == here);
    const Events events = world.update();
    const Events same = other.update();
    expect(std::ranges::equal(events.begun, same.begun) && std::ranges::equal(events.ended, same.ended));
  }
  expect(other.snapshot() == world.snapshot());
}

template <int D, typename Real>
void check(const Bytes& bytes) {
  World<D, Real> world("brute_force");
  world.add(unit_box<D, Real>());
  world.update();
  const Bytes before = world.snapshot();
  try {
    world.restore(bytes);
  } catch (const InvalidSnapshot&) {
    expect(world.snapshot() == before);
    return;
  }
  check_lives_on(world);
}

void check(const Bytes& bytes) {
  check<2, float>(bytes);
  check<3, double>(bytes);
}

/// `bytes` with the length and the checksum that they should have.
Bytes sealed(Bytes bytes) {
  constexpr std::size_t length_at = 16;
  if (bytes.size() < length_at + 12) return bytes;
  const auto put = [&bytes](std::size_t at, std::uint64_t value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<std::byte>(value >> 8 * i & 0xff);
  };
  put(length_at, bytes.size(), 8);
  trace::Checksum checksum;
  checksum.add(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size() - 4);
  put(bytes.size() - 4, checksum.value(), 4);
  return bytes;
}

}  // namespace
}  // namespace broadside

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto* const begin = reinterpret_cast<const std::byte*>(data);
  const broadside::Bytes bytes(begin, begin + size);
  broadside::check(bytes);
  // Few random bytes have the right checksum: what lies behind it is tried as well.
  broadside::check(broadside::sealed(bytes));
  return 0;
}
