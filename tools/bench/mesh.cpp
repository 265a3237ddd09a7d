// Dense joins: pairs of mesh elements that may touch between two times: mesh BEFORE AFTER [ROUNDS
// [ALGORITHM]]. Pairs are vertex-face and edge-edge. Both the computation of the boxes and the search are
// timed: the speedup of two threads (see bench/gain.hpp), and the cost of doubles over floats.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "bench/gain.hpp"
#include "bench/guarded.hpp"
#include "lab/formats/mesh/elements.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"
#include "lab/report/machine.hpp"

namespace broadside::bench {
namespace {

struct Mesh {
  lab::IndexedMesh before;
  lab::IndexedMesh after;
  lab::MeshElements vertices;
  lab::MeshElements edges;
  lab::MeshElements faces;
};

lab::IndexedMesh read(const std::string& path) {
  lab::Input input(path);
  return lab::read_mesh(input);
}

Mesh read_both(const std::string& before, const std::string& after) {
  lab::IndexedMesh first = read(before);
  lab::IndexedMesh second = read(after);
  if (first.vertices.size() != second.vertices.size() || first.corners != second.corners)
    throw std::runtime_error(fmt::format(
        "{} and {} have different vertices or faces; expected one mesh at two times", before, after));
  return {.before = first,
          .after = std::move(second),
          .vertices = {first, lab::MeshPart::vertices},
          .edges = {first, lab::MeshPart::edges},
          .faces = {first, lab::MeshPart::faces}};
}

/// Finds the pairs between two sets of elements, or within one.
template <typename Real>
class Joining final : public Work {
 public:
  Joining(const Mesh& mesh, const lab::MeshElements& left, const lab::MeshElements& right,
          const std::string& algorithm, const Workers& workers)
      : left_(left), right_(right), finder_(algorithm), threads_(workers.threads) {
    finder_.set_workers(workers);
    for (const lab::IndexedMesh* const time : {&mesh.before, &mesh.after}) {
      for (const std::array<double, 3>& vertex : time->vertices) {
        for (const double coordinate : vertex) places_.push_back(static_cast<Real>(coordinate));
      }
    }
  }

  void prepare(std::size_t) override { pairs_.clear(); }

  void run() override {
    sweep(left_, left_boxes_);
    PairCollector collector(pairs_);
    if (&left_ == &right_) {
      finder_.find(left_boxes_, collector);
      return;
    }
    sweep(right_, right_boxes_);
    finder_.find_between(left_boxes_, right_boxes_, collector);
  }

  std::uint64_t hash() const override { return hash_of(pairs_); }
  std::size_t pair_count() const { return pairs_.size(); }

 private:
  using Boxes = std::vector<Box<3, Real>>;

  /// Computes the bounds of each element over both times, with as many threads as the search.
  void sweep(const lab::MeshElements& elements, Boxes& boxes) const {
    boxes.resize(elements.size());
    const std::size_t half = threads_ == 2 ? boxes.size() / 2 : 0;
    std::future<void> other;
    if (half > 0) other = std::async(std::launch::async, [&] { sweep(elements, boxes, 0, half); });
    sweep(elements, boxes, half, boxes.size());
    if (half > 0) other.get();
  }

  void sweep(const lab::MeshElements& elements, Boxes& boxes, std::size_t begin, std::size_t end) const {
    const std::size_t later = places_.size() / 2;
    for (std::size_t element = begin; element < end; ++element) {
      Box<3, Real> box = absent_box<3, Real>();
      for (const std::uint32_t vertex : elements.vertices(element)) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const Real before = places_[3 * vertex + axis];
          const Real after = places_[later + 3 * vertex + axis];
          box.min[axis] = std::min({box.min[axis], before, after});
          box.max[axis] = std::max({box.max[axis], before, after});
        }
      }
      boxes[element] = box;
    }
  }

  const lab::MeshElements& left_;
  const lab::MeshElements& right_;
  std::vector<Real> places_;  // x, y and z of each vertex, before and after
  Finder<3, Real> finder_;
  std::size_t threads_;
  Boxes left_boxes_;
  Boxes right_boxes_;
  std::vector<Pair> pairs_;
};

void run(const std::string& before, const std::string& after, std::size_t rounds,
         const std::string& algorithm) {
  if (rounds < 2)
    throw std::invalid_argument(fmt::format(
        "the number of rounds is {}; expected 2 or more, the first of which does not count", rounds));
  const Mesh mesh = read_both(before, after);
  const lab::Machine machine = lab::this_machine();
  const lab::Build build = lab::this_build();
  fmt::print("{} vertices, {} edges, {} faces, medians of {} rounds; {}, {} cores; {}, {}\n",
             lab::grouped(mesh.vertices.size()), lab::grouped(mesh.edges.size()),
             lab::grouped(mesh.faces.size()), rounds - 1, machine.cpu, machine.cores, build.compiler,
             build.revision);
  lab::AlignedColumns gains = gain_columns(2);
  lab::AlignedColumns doubles("<>>>>");
  doubles.add({"", "pairs", "floats, ms", "doubles, ms", "ratio"});
  const auto join = [&](const std::string& name, const lab::MeshElements& left,
                        const lab::MeshElements& right) {
    const auto maker = [&]<typename Real>(Real) {
      return [&](const Workers& workers) {
        return std::make_unique<Joining<Real>>(mesh, left, right, algorithm, workers);
      };
    };
    add_gain(name + ", floats", maker(float()), 2, rounds, gains);
    add_gain(name + ", doubles", maker(double()), 2, rounds, gains);
    const auto floats = maker(float())({});
    const auto exact = maker(double())({});
    std::vector<double> float_ms;
    std::vector<double> double_ms;
    std::vector<double> ratios;
    for (std::size_t round = 0; round < rounds; ++round) {
      floats->prepare(round);
      exact->prepare(round);
      float_ms.push_back(milliseconds_of([&] { floats->run(); }));
      double_ms.push_back(milliseconds_of([&] { exact->run(); }));
      ratios.push_back(double_ms.back() / float_ms.back());
    }
    doubles.add({name, lab::grouped(exact->pair_count()), lab::rounded(lab::median(float_ms)),
                 lab::rounded(lab::median(double_ms)), fmt::format("{:.2f}", lab::median(ratios))});
  };
  join("vertices with faces", mesh.vertices, mesh.faces);
  join("edges with edges", mesh.edges, mesh.edges);
  fmt::print("{}\n{}", text_of_gains(gains), doubles.text("  "));
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("mesh", 1, [&] {
    if (count < 3)
      throw std::invalid_argument(
          fmt::format("{} files are given; expected two, a mesh at two times", count - 1));
    run(arguments[1], arguments[2], number_at(count, arguments, 3, 11), text_at(count, arguments, 4, "auto"));
    return 0;
  });
}
