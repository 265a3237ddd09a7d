// The parts of C++20 that the library uses and that libc++ 13, the standard library of Debian's Emscripten,
// does not have: algorithms over ranges, std::bit_cast and std::make_unique_for_overwrite. Included before
// every source by CMakeLists.txt.
//
// Only the forms that the library calls are here: whole ranges, and iterators where it has them. A newer
// libc++ has its own, and then this file is empty.
#pragma once

#include <version>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 15000

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <iterator>
#include <memory>
#include <ranges>
#include <system_error>
#include <tuple>
#include <type_traits>
#include <utility>

// The standard forbids additions to namespace std. This one known version of libc++ is the exception: the
// library looks for these names there.
namespace std {

template <typename To, typename From>
requires(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> &&
         is_trivially_copyable_v<From>) constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

template <typename T>
unique_ptr<T> make_unique_for_overwrite() {
  return unique_ptr<T>(new T);
}

/// For the captions of the paper's grid.
inline to_chars_result to_chars(char* first, char* last, double value, chars_format, int precision) {
  return {first + snprintf(first, static_cast<size_t>(last - first), "%.*g", precision, value), errc()};
}

namespace ranges {

template <typename Before, typename Projection>
constexpr auto projected_order(Before& before, Projection& projection) {
  return [&](const auto& a, const auto& b) {
    return invoke(before, invoke(projection, a), invoke(projection, b));
  };
}

template <typename Range, typename Predicate, typename Projection = identity>
constexpr auto find_if(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::find_if(begin(range), end(range),
                      [&](const auto& element) { return invoke(predicate, invoke(projection, element)); });
}

template <typename Range, typename Predicate, typename Projection = identity>
constexpr bool any_of(Range&& range, Predicate predicate, Projection projection = {}) {
  return find_if(range, ref(predicate), projection) != end(range);
}

template <typename Range, typename Predicate>
constexpr bool all_of(Range&& range, Predicate predicate) {
  return std::all_of(begin(range), end(range), ref(predicate));
}

template <typename Range, typename Predicate>
constexpr auto count_if(Range&& range, Predicate predicate) {
  return std::count_if(begin(range), end(range), ref(predicate));
}

template <typename Range, typename Value, typename Projection = identity>
constexpr auto count(Range&& range, const Value& value, Projection projection = {}) {
  return std::count_if(begin(range), end(range),
                       [&](const auto& element) { return invoke(projection, element) == value; });
}

template <typename Range, typename Value, typename Projection = identity>
constexpr auto find(Range&& range, const Value& value, Projection projection = {}) {
  return std::find_if(begin(range), end(range),
                      [&](const auto& element) { return invoke(projection, element) == value; });
}

/// Heapsort, for ranges that quicksort divides badly.
template <typename At, typename Before>
constexpr void sort_by_heap(At first, ptrdiff_t count, Before before) {
  const auto sift_down = [&](ptrdiff_t parent, ptrdiff_t last) {
    auto sinking = std::move(first[parent]);
    for (ptrdiff_t child; (child = 2 * parent + 1) < last; parent = child) {
      if (child + 1 < last && before(first[child], first[child + 1])) ++child;
      if (!before(sinking, first[child])) break;
      first[parent] = std::move(first[child]);
    }
    first[parent] = std::move(sinking);
  };
  for (ptrdiff_t parent = count / 2; parent-- > 0;) sift_down(parent, count);
  for (ptrdiff_t last = count; --last > 0;) {
    std::swap(first[0], first[last]);
    sift_down(0, last);
  }
}

template <typename At, typename Before>
constexpr void sort_by_insertion(At first, At last, Before before) {
  for (At at = first; at != last; ++at) {
    auto moved = std::move(*at);
    At to = at;
    for (; to != first && before(moved, to[-1]); --to) *to = std::move(to[-1]);
    *to = std::move(moved);
  }
}

/// Introsort in a tenth of the code of libc++'s, which is instantiated for each type.
template <typename At, typename Before>
constexpr void sort_range(At first, At last, Before before, int depth) {
  constexpr ptrdiff_t few = 16;
  while (last - first > few) {
    if (depth-- == 0) return sort_by_heap(first, last - first, before);
    // The median of three is the pivot; the other two stop both loops.
    At middle = first + (last - first) / 2;
    if (before(*middle, *first)) std::swap(*middle, *first);
    if (before(last[-1], *first)) std::swap(last[-1], *first);
    if (before(last[-1], *middle)) std::swap(last[-1], *middle);
    const auto pivot = *middle;
    At low = first;
    At high = last - 1;
    for (;;) {
      while (before(*low, pivot)) ++low;
      while (before(pivot, *high)) --high;
      if (low >= high) break;
      std::swap(*low++, *high--);
    }
    sort_range(low, last, before, depth);
    last = low;
  }
  sort_by_insertion(first, last, before);
}

template <typename Range, typename Before = less, typename Projection = identity>
constexpr void sort(Range&& range, Before before = {}, Projection projection = {}) {
  if (begin(range) == end(range)) return;
  auto* const first = std::addressof(*begin(range));
  const auto count = end(range) - begin(range);
  if constexpr (requires { tuple_size<remove_cvref_t<Range>>::value; }) {  // of a fixed length, so short
    sort_by_insertion(first, first + count, projected_order(before, projection));
  } else {
    int depth = 2;
    for (auto left = count; left > 1; left /= 2) depth += 2;
    sort_range(first, first + count, projected_order(before, projection), depth);
  }
}

template <typename Range, typename Before = less>
constexpr void nth_element(Range&& range, iterator_t<Range> nth, Before before = {}) {
  std::nth_element(begin(range), nth, end(range), ref(before));
}

template <typename Range, typename Before = less>
constexpr void push_heap(Range&& range, Before before = {}) {
  std::push_heap(begin(range), end(range), ref(before));
}

template <typename Range, typename Before = less>
constexpr void pop_heap(Range&& range, Before before = {}) {
  std::pop_heap(begin(range), end(range), ref(before));
}

template <typename Range, typename Before = less>
constexpr void sort_heap(Range&& range, Before before = {}) {
  std::sort_heap(begin(range), end(range), ref(before));
}

template <typename Range, typename Before = less>
constexpr bool is_sorted(Range&& range, Before before = {}) {
  return std::is_sorted(begin(range), end(range), ref(before));
}

template <typename Range, typename Value>
constexpr bool binary_search(Range&& range, const Value& value) {
  return std::binary_search(begin(range), end(range), value);
}

template <typename Range, typename Value>
constexpr auto lower_bound(Range&& range, const Value& value) {
  return std::lower_bound(begin(range), end(range), value);
}

template <typename Range, typename Value>
constexpr auto upper_bound(Range&& range, const Value& value) {
  return std::upper_bound(begin(range), end(range), value);
}

template <typename Range>
constexpr auto max_element(Range&& range) {
  return std::max_element(begin(range), end(range));
}

template <typename Range>
constexpr auto min_element(Range&& range) {
  return std::min_element(begin(range), end(range));
}

template <typename Range, typename Predicate = equal_to>
constexpr auto adjacent_find(Range&& range, Predicate predicate = {}) {
  return std::adjacent_find(begin(range), end(range), ref(predicate));
}

template <typename Left, typename Right>
constexpr auto mismatch(Left&& left, Right&& right) {
  struct Result {
    iterator_t<Left> in1;
    iterator_t<Right> in2;
  };
  const auto [in1, in2] = std::mismatch(begin(left), end(left), begin(right), end(right));
  return Result{in1, in2};
}

template <typename Range, typename To>
constexpr void copy(Range&& range, To to) {
  std::copy(begin(range), end(range), to);
}

template <typename Range, typename To, typename Predicate>
constexpr void copy_if(Range&& range, To to, Predicate predicate) {
  std::copy_if(begin(range), end(range), to, ref(predicate));
}

template <typename Range, typename To, typename Function>
constexpr void transform(Range&& range, To to, Function function) {
  std::transform(begin(range), end(range), to, ref(function));
}

template <typename Range, typename Value>
constexpr void replace(Range&& range, const Value& from, const Value& to) {
  std::replace(begin(range), end(range), from, to);
}

template <typename Range, typename Predicate, typename Value>
constexpr void replace_if(Range&& range, Predicate predicate, const Value& to) {
  std::replace_if(begin(range), end(range), ref(predicate), to);
}

template <typename Range>
constexpr void reverse(Range&& range) {
  std::reverse(begin(range), end(range));
}

template <typename Left, typename Right>
constexpr bool includes(Left&& left, Right&& right) {
  return std::includes(begin(left), end(left), begin(right), end(right));
}

template <typename Left, typename Right, typename To>
constexpr void merge(Left&& left, Right&& right, To to) {
  std::merge(begin(left), end(left), begin(right), end(right), to);
}

template <typename Left, typename Right, typename To>
constexpr void set_union(Left&& left, Right&& right, To to) {
  std::set_union(begin(left), end(left), begin(right), end(right), to);
}

template <typename Left, typename Right, typename To>
constexpr void set_difference(Left&& left, Right&& right, To to) {
  std::set_difference(begin(left), end(left), begin(right), end(right), to);
}

template <typename Left, typename Right, typename To>
constexpr void set_symmetric_difference(Left&& left, Right&& right, To to) {
  std::set_symmetric_difference(begin(left), end(left), begin(right), end(right), to);
}

}  // namespace ranges
}  // namespace std

#endif
