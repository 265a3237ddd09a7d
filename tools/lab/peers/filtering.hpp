// Filters of boxes for libraries that have their own means to filter.
#pragma once

#include <span>

#include "broadside/filter.hpp"

namespace broadside::lab::peers {

/// A searcher whose library can leave out pairs that the boxes' filters reject. It need not leave out all.
class Filtering {
 public:
  virtual ~Filtering() = default;

  /// Sets the filters of the boxes of the next searches; empty for none. They must outlive these. A search of
  /// another number of boxes, because some are absent, does not use them.
  virtual void set_filters(std::span<const Filter> filters) = 0;

 protected:
  Filtering() = default;
  Filtering(const Filtering&) = default;
  Filtering& operator=(const Filtering&) = default;
};

}  // namespace broadside::lab::peers
