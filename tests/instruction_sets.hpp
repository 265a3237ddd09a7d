// The instruction sets that the kernels were compiled for, by name, so that tests can run on each of them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <hwy/targets.h>

namespace broadside {

/// The instruction sets that this program holds and this processor has, the best one first; the last one is
/// plain C++.
inline std::vector<std::string> instruction_sets_here() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

/// Whether there is an instruction set of that name for processors of this kind.
inline bool is_instruction_set(std::string_view name) {
  for (int bit = 0; bit < 63; ++bit) {
    const std::string_view known = hwy::TargetName(std::int64_t{1} << bit);
    if (known != "Unknown" && known == name) return true;
  }
  return false;
}

/// Has all kernels run on the instruction set `name`, one of instruction_sets_here(), while it lives. Not
/// while another thread finds pairs.
class OnInstructionSet {
 public:
  explicit OnInstructionSet(std::string_view name) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      if (hwy::TargetName(target) == name) choose(target);
    }
  }

  ~OnInstructionSet() { choose(0); }

  OnInstructionSet(const OnInstructionSet&) = delete;
  OnInstructionSet& operator=(const OnInstructionSet&) = delete;

 private:
  /// Takes `target` for all there is, or, if it is 0, what there is.
  static void choose(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

}  // namespace broadside
