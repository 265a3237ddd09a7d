// Baseline for bench/python/compare.py: find_pairs() of floats in 2D, by the same library.
//
//   cmake --build build/python/cmake --target broadside
//   g++ -std=c++20 -O3 -DNDEBUG -I include tools/bench/python/cpp_times.cpp
//     build/python/cmake/src/libbroadside.a -lhwy -pthread -o build/python/cpp_times
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <malloc.h>

#include "broadside/find_pairs.hpp"

int main(int count, char** arguments) {
  using namespace broadside;
  if (count != 3) {
    std::fputs("usage: cpp_times FILE CALLS\n", stderr);
    return 2;
  }
  // Keep freed memory, as a Python process does that has run for a while. Otherwise each call here would pay
  // for fresh pages, and Python would look twice as fast.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  std::ifstream file(arguments[1], std::ios::binary | std::ios::ate);
  std::vector<Box2> boxes(static_cast<std::size_t>(file.tellg()) / sizeof(Box2));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(boxes.data()), static_cast<std::streamsize>(boxes.size() * sizeof(Box2)));
  const int calls = std::atoi(arguments[2]);
  std::size_t pairs = 0;
  double best = 1e300;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) pairs = find_pairs(boxes).size();
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    best = std::min(best, passed.count() / calls);
  }
  std::printf("%zu %.9f\n", pairs, best);
}
