// Excludes the destruction of a library's structure from the time of a search.
#pragma once

namespace broadside::lab::peers {

/// A searcher that keeps its library's structure after the search, so that it can be destroyed after the
/// clock has stopped. The next search destroys a structure that is still there.
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
