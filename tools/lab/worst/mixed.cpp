// Families made of other families: misled samples, mixtures, and crowds of two sets.
#include <algorithm>

#include "lab/worst/boxes.hpp"
#include "lab/worst/family.hpp"
#include "src/core/bit_cast.hpp"

namespace broadside::lab::worst {
namespace {

/// As core::sampled_place().
std::size_t golden_place(std::size_t i, std::size_t count) {
  const auto fraction = static_cast<std::uint32_t>(i * 0x9e3779b9U);
  return static_cast<std::size_t>(fraction * std::uint64_t{count} >> 32);
}

/// The places of an array of `count` at which a library may sample: at steps of the golden ratio, at even
/// steps, or at the ends.
std::vector<bool> sampled_places(const std::string& places, std::size_t count, std::size_t samples) {
  std::vector<bool> sampled(count);
  const auto mark = [&](std::size_t place) { sampled[std::min(place, count - 1)] = true; };
  const bool all = places == "all";
  for (std::size_t i = 0; i < std::min(samples, count); ++i) {
    if (all || places == "golden") mark(golden_place(i, count));
    if (all || places == "ends") {
      mark(i);
      mark(count - 1 - i);
    }
  }
  for (std::size_t few = 16; (all || places == "even") && few <= std::min(samples, count); few *= 2) {
    for (const std::size_t of : {few, few + few / 2}) {
      for (std::size_t i = 0; i < of; ++i) {
        mark((2 * i + 1) * count / (2 * of));
        mark(i * count / of);
      }
    }
  }
  return sampled;
}

/// As core::sample_shift() of the boxes as floats, which hashes as many boxes as `auto` does.
template <int D>
std::uint32_t shift_of_auto(const DoubleBoxes<D>& boxes) {
  std::uint64_t hash = boxes.size();
  for (std::size_t i = 0; i < std::min<std::size_t>(boxes.size(), 32); ++i) {
    for (const double coordinate : boxes[golden_place(i, boxes.size())].min)
      hash = detail::mixed(hash + core::bit_cast<std::uint32_t>(static_cast<float>(coordinate)));
  }
  return static_cast<std::uint32_t>(hash);
}

/// Harmless boxes at the places of a sample, others elsewhere.
struct Fooled {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    if (count == 0) return {};
    const auto samples = static_cast<std::size_t>(settings.integer("samples"));
    const std::vector<bool> sampled = sampled_places(settings.text("places"), count, samples);
    const auto shown = static_cast<std::size_t>(std::ranges::count(sampled, true));
    const Spec hidden = hidden_spec(settings.text("hidden"), random);
    const DoubleBoxes<D> others = make_family<D>(hidden, count - shown, random);
    // As large as if all boxes were of this kind.
    const double side = side_for<D>(1, count);
    const double away = settings.text("where") == "beside" ? 2 : 0;
    const auto harmless = [&] {
      Point<D> min = anywhere<D>(random);
      min[D - 1] += away;
      return box_at<D>(min, cube<D>(side));
    };
    DoubleBoxes<D> boxes;
    auto other = others.begin();
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(sampled[i] ? harmless() : *other++);
    if (const std::string& places = settings.text("places"); places == "even" || places == "ends")
      return boxes;
    // Where `auto` samples depends on the boxes at the first sampled places, which stay as they are.
    const std::uint32_t shift = shift_of_auto<D>(boxes);
    for (std::size_t i = 0; i < samples; ++i) {
      const std::size_t place = golden_place(i + shift, count);
      if (!sampled[place]) boxes[place] = harmless();
    }
    return boxes;
  }

  static Spec hidden_spec(const std::string& name, Random& random) {
    return draw_family(find_family(name), random);
  }
};

/// Two families in one scene.
struct Mixture {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const auto first = static_cast<std::size_t>(settings.number("part") * static_cast<double>(count));
    const auto drawn = [&](std::string_view which, std::size_t boxes) {
      return make_family<D>(draw_family(find_family(settings.text(which)), random), boxes, random);
    };
    DoubleBoxes<D> boxes = drawn("first", first);
    const DoubleBoxes<D> others = drawn("second", count - first);
    const double away = settings.text("where") == "beside" ? 2 : 0;
    for (Box<D, double> box : others) {
      box.min[0] += away;
      box.max[0] += away;
      boxes.push_back(box);
    }
    return boxes;
  }
};

/// Two sets whose boxes overlap within each set, but hardly with the other set.
struct Crowds {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const double gap = settings.number("gap");
    const bool comb = settings.text("shape") == "comb";
    DoubleBoxes<D> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_right = i >= count / 2;
      Point<D> min = anywhere<D>(random);
      Size<D> size = cube<D>(1 + gap);
      // Teeth of a comb: some places on an axis belong to one set, those between them to the other.
      const double tooth = comb ? static_cast<double>(random.below(16)) * 2 : 0;
      min[0] = (is_right ? 1 : 0) + tooth;
      size[0] = 0.99;
      if (!comb && !is_right) size[D - 1] = 1 + gap;
      boxes.push_back(box_at<D>(min, size));
    }
    return boxes;
  }
};

const std::vector<std::string>& hard_families() {
  static const std::vector<std::string> list = {"plates", "lines",      "clusters", "shelves", "row",
                                                "dust",   "magnitudes", "heaps",    "giants",  "dolls"};
  return list;
}

}  // namespace

InputFamily fooled() {
  InputFamily family = family_of<Fooled>(
      "fooled", "even boxes where a sample of the array looks, others elsewhere",
      {choice("hidden", "the family elsewhere, its values drawn", hard_families()),
       choice("places", "where even boxes lie in the array", {"all", "golden", "even", "ends"}),
       count("samples", "even boxes", "512", 64, 2048),
       choice("where", "where even boxes lie in space", {"over", "beside"})});
  family.fixed_order = true;
  return family;
}

InputFamily mixture() {
  std::vector<std::string> second = hard_families();
  std::rotate(second.begin(), second.begin() + 1, second.end());
  return family_of<Mixture>("mixture", "two families in one scene",
                            {choice("first", "a family, its values drawn", hard_families()),
                             choice("second", "another", std::move(second)),
                             number("part", "of the boxes that are of the first", "0.5", 0.01, 0.99),
                             choice("where", "whether they lie in one place", {"over", "beside"})});
}

InputFamily crowds() {
  InputFamily family =
      family_of<Crowds>("crowds", "two sets: boxes overlap within a set and not with the other",
                        {magnitude("gap", "how much longer than the world boxes are", "0.1", 1e-3, 10),
                         choice("shape", "of the sets", {"comb", "halves"})});
  family.fixed_order = true;
  family.two_sets = true;
  return family;
}

}  // namespace broadside::lab::worst
