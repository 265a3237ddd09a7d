// What a library's structure takes to be torn down is not part of a search.
#pragma once

namespace broadside::lab::peers {

/// A searcher that keeps its library's structure after the search, so that the structure can be torn down
/// after the clock has stopped. The next search tears down what is still there.
class TearDown {
 public:
  virtual ~TearDown() = default;
  virtual void tear_down() = 0;

 protected:
  TearDown() = default;
  TearDown(const TearDown&) = default;
  TearDown& operator=(const TearDown&) = default;
};

}  // namespace broadside::lab::peers
