// Pairs as a table of two columns, by the Arrow C data interface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "broadside/pair.hpp"

namespace broadside::python {

/// The columns `first` and `second`. Importers share their memory.
class PairTable {
 public:
  explicit PairTable(std::span<const Pair> pairs);

  std::size_t size() const noexcept { return columns_->first.size(); }

  struct PairColumns {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> second;
  };
  const std::shared_ptr<const PairColumns>& columns() const noexcept { return columns_; }

 private:
  std::shared_ptr<const PairColumns> columns_;
};

}  // namespace broadside::python
