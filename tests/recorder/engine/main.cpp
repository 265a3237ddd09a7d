// An engine of C++11 with a recorder: does what it is told on standard input, a call a line, and prints what
// failed. Usage: plain_engine PATH DIMENSION BYTES_OF_A_COORDINATE [MARGIN] < script
//
// It sees the one header alone, as an engine does that it was copied into.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "recorder.hpp"

namespace {

template <typename Real>
std::vector<Real> read_coordinates(std::size_t count) {
  std::vector<Real> coordinates(count);
  std::string text;
  for (Real& coordinate : coordinates) {
    std::cin >> text;
    coordinate = static_cast<Real>(std::strtod(text.c_str(), nullptr));
  }
  return coordinates;
}

template <int D, typename Real>
int run(const char* path, const char* margin) {
  broadside::Recorder<D, Real> recorder;
  if (margin == nullptr)
    recorder.open(path);
  else
    recorder.open(path, std::strtod(margin, nullptr));
  std::string call;
  while (std::cin >> call) {
    if (call == "end_frame") {
      recorder.end_frame();
      continue;
    }
    std::uint32_t number = 0;
    std::cin >> number;
    if (call == "set") {
      const std::vector<Real> box = read_coordinates<Real>(2 * D);
      recorder.set(number, box.data(), box.data() + D);
    } else if (call == "set_boxes") {
      const std::vector<Real> boxes = read_coordinates<Real>(2 * D * std::size_t{number});
      recorder.set_boxes(boxes.data(), number);
    } else if (call == "remove") {
      recorder.remove(number);
    } else if (call == "resize") {
      recorder.resize(number);
    } else if (call == "set_filter") {
      std::uint64_t category = 0;
      std::uint64_t mask = 0;
      std::int32_t group = 0;
      bool is_static = false;
      std::cin >> category >> mask >> group >> is_static;
      recorder.set_filter(number, category, mask, group, is_static);
    } else if (call == "add_pair" || call == "ignore_pair") {
      std::uint32_t other = 0;
      std::cin >> other;
      call == "add_pair" ? recorder.add_pair(number, other) : recorder.ignore_pair(number, other);
    } else {
      std::printf("the call is '%s'; expected one of the recorder's\n", call.c_str());
      return 2;
    }
  }
  if (recorder.close()) return 0;
  std::puts(recorder.error().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) return 2;
  const char* const margin = argc == 5 ? argv[4] : nullptr;
  const bool is_flat = std::atoi(argv[2]) == 2;
  const bool is_float = std::atoi(argv[3]) == 4;
  if (is_flat) return is_float ? run<2, float>(argv[1], margin) : run<2, double>(argv[1], margin);
  return is_float ? run<3, float>(argv[1], margin) : run<3, double>(argv[1], margin);
}
