// Components: the connected components of pairs, without keeping these.
#include "broadside/components.hpp"

#include <utility>

#include "broadside/error.hpp"

#include "core/input_check.hpp"
#include "core/message.hpp"

namespace broadside {

Components::Components(std::size_t boxes) {
  core::check_count(boxes);
  parents_.resize(boxes);
  for (std::size_t i = 0; i < boxes; ++i) parents_[i] = BoxId(i);
}

std::vector<BoxId> Components::labels() {
  flush();
  // A parent is never greater than its box, so its own parent is a root by now.
  for (BoxId& parent : parents_) parent = parents_[parent];
  return parents_;
}

std::unique_ptr<PairSink> Components::empty_clone() const {
  return std::make_unique<Components>(parents_.size());
}

void Components::merge(PairSink& clone) {
  const std::vector<BoxId>& parents = static_cast<Components&>(clone).parents_;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] != i) unite(BoxId(i), parents[i]);
  }
}

void Components::consume(std::span<const Pair> pairs) {
  for (const Pair pair : pairs) {
    for (const BoxId box : {pair.first, pair.second}) {
      if (index(box) >= parents_.size())
        throw InvalidFrame(core::message({"a pair has box ", index(box), "; expected an id below ",
                                          parents_.size(), ", the number of boxes"}));
    }
    unite(pair.first, pair.second);
  }
}

BoxId Components::root(BoxId box) noexcept {
  while (parents_[box] != box) box = parents_[box] = parents_[parents_[box]];
  return box;
}

void Components::unite(BoxId a, BoxId b) noexcept {
  a = root(a);
  b = root(b);
  if (a < b) std::swap(a, b);
  parents_[a] = b;
}

}  // namespace broadside
