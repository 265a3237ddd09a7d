// BoxView: boxes in the caller's memory, as a range.
#pragma once

#include <compare>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

#include "broadside/box.hpp"

namespace broadside {

template <int D, typename Real = float>
class BoxView;

namespace detail {
template <typename T, int D, typename Real>
concept ArrayOfBoxes =
    !std::same_as<T, BoxView<D, Real>> && std::convertible_to<const T&, std::span<const Box<D, Real>>>;
}  // namespace detail

/// A range of boxes in the caller's memory: an array of boxes, or structs that contain boxes, one every
/// `stride` bytes. Nothing is copied, and the memory must outlive the view. Elements are returned by value.
template <int D, typename Real>
class BoxView {
 public:
  class Iterator;
  using value_type = Box<D, Real>;  // NOLINT(readability-identifier-naming)

  BoxView() = default;

  /// The boxes of a std::vector, std::array, std::span or C array.
  template <detail::ArrayOfBoxes<D, Real> Boxes>
  constexpr BoxView(const Boxes& boxes) : BoxView(std::span<const Box<D, Real>>(boxes)) {}
  constexpr BoxView(std::span<const Box<D, Real>> boxes) : boxes_(boxes.data()), size_(boxes.size()) {}

  /// `count` boxes: the first at `first`, and each further one `stride` bytes after the previous one. A box
  /// is its D minima followed by its D maxima, as in Box, and need not be aligned.
  BoxView(const void* first, std::size_t count, std::size_t stride)
      : first_(static_cast<const std::byte*>(first)), stride_(stride), size_(count) {}

  [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
  [[nodiscard]] constexpr bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] constexpr Iterator begin() const noexcept { return {*this, 0}; }
  [[nodiscard]] constexpr Iterator end() const noexcept { return {*this, size_}; }

  [[nodiscard]] constexpr Box<D, Real> operator[](std::size_t place) const noexcept {
    if (first_ == nullptr) return boxes_[place];
    Box<D, Real> box;
    std::memcpy(&box, first_ + place * stride_, sizeof(box));
    return box;
  }

  /// The boxes as an array if the view was made from an array; otherwise null.
  [[nodiscard]] constexpr const Box<D, Real>* array() const noexcept {
    return first_ == nullptr ? boxes_ : nullptr;
  }
  [[nodiscard]] constexpr bool is_array() const noexcept { return first_ == nullptr; }

  /// The address of the first box.
  [[nodiscard]] const std::byte* first_byte() const noexcept {
    return first_ != nullptr ? first_ : reinterpret_cast<const std::byte*>(boxes_);
  }

 private:
  const Box<D, Real>* boxes_ = nullptr;
  const std::byte* first_ = nullptr;
  std::size_t stride_ = 0;
  std::size_t size_ = 0;
};

/// A random access iterator over the boxes of a view. It may outlive the view.
template <int D, typename Real>
class BoxView<D, Real>::Iterator {
 public:
  using iterator_concept = std::random_access_iterator_tag;  // NOLINT(readability-identifier-naming)
  using iterator_category = std::input_iterator_tag;         // NOLINT(readability-identifier-naming)
  using value_type = Box<D, Real>;                           // NOLINT(readability-identifier-naming)
  using difference_type = std::ptrdiff_t;                    // NOLINT(readability-identifier-naming)
  using pointer = void;                                      // NOLINT(readability-identifier-naming)
  using reference = Box<D, Real>;                            // NOLINT(readability-identifier-naming)

  Iterator() = default;
  constexpr Iterator(const BoxView& view, std::size_t place) noexcept
      : view_(view), place_(static_cast<difference_type>(place)) {}

  constexpr reference operator*() const noexcept { return view_[static_cast<std::size_t>(place_)]; }
  constexpr reference operator[](difference_type offset) const noexcept { return *(*this + offset); }

  constexpr Iterator& operator+=(difference_type offset) noexcept {
    place_ += offset;
    return *this;
  }
  constexpr Iterator& operator-=(difference_type offset) noexcept { return *this += -offset; }
  constexpr Iterator& operator++() noexcept { return *this += 1; }
  constexpr Iterator& operator--() noexcept { return *this -= 1; }
  constexpr Iterator operator++(int) noexcept {
    const Iterator old = *this;
    ++*this;
    return old;
  }
  constexpr Iterator operator--(int) noexcept {
    const Iterator old = *this;
    --*this;
    return old;
  }

  friend constexpr Iterator operator+(Iterator it, difference_type offset) noexcept { return it += offset; }
  friend constexpr Iterator operator+(difference_type offset, Iterator it) noexcept { return it += offset; }
  friend constexpr Iterator operator-(Iterator it, difference_type offset) noexcept { return it -= offset; }
  friend constexpr difference_type operator-(const Iterator& a, const Iterator& b) noexcept {
    return a.place_ - b.place_;
  }
  friend constexpr bool operator==(const Iterator& a, const Iterator& b) noexcept {
    return a.place_ == b.place_;
  }
  friend constexpr auto operator<=>(const Iterator& a, const Iterator& b) noexcept {
    return a.place_ <=> b.place_;
  }

 private:
  BoxView view_{};
  difference_type place_ = 0;
};

namespace detail {
template <typename T>
struct ViewOfBox {};
template <int D, typename Real>
requires is_supported<D, Real>
struct ViewOfBox<Box<D, Real>> {
  using type = BoxView<D, Real>;  // NOLINT(readability-identifier-naming)
};

/// The BoxView to which a range of boxes converts.
template <typename Boxes>
using ViewOf = typename ViewOfBox<std::remove_cvref_t<decltype(std::declval<const Boxes&>()[0])>>::type;
}  // namespace detail

/// A std::vector, std::array, std::span or C array of Box<2>, Box<3>, DoubleBox2 or DoubleBox3; or a BoxView.
template <typename T>
concept BoxRange = std::convertible_to<const T&, detail::ViewOf<T>>;

}  // namespace broadside

template <int D, typename Real>
inline constexpr bool std::ranges::enable_borrowed_range<broadside::BoxView<D, Real>> = true;
template <int D, typename Real>
inline constexpr bool std::ranges::enable_view<broadside::BoxView<D, Real>> = true;
