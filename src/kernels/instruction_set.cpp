// The instruction set that the kernels are dispatched to.
#include <cstdint>

#include "broadside/error.hpp"
#include "broadside/executor.hpp"

#include "kernels/instruction_set_name.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/instruction_set.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace broadside::HWY_NAMESPACE {
const char* target_name() { return hwy::TargetName(HWY_TARGET); }
}  // namespace broadside::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside {
namespace {

#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0
// There is only one target, and Highway then calls it directly: its headers alone are enough to link.
void choose(std::int64_t) {}

std::vector<std::int64_t> targets() { return {HWY_TARGETS}; }
#else
/// Makes Highway treat `target` as the processor's only one; 0 restores the targets that it really has.
/// Highway's only way to narrow the choice at run time is the one for its own tests.
void choose(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// The targets that the processor and the library have in common, whatever was chosen.
const std::vector<std::int64_t>& targets() {
  static const std::vector<std::int64_t> all = hwy::SupportedAndGeneratedTargets();
  return all;
}
#endif

}  // namespace

HWY_EXPORT(target_name);

std::string instruction_set() { return kernels::instruction_set_name(HWY_DYNAMIC_DISPATCH(target_name)()); }

std::span<const std::string> detail::instruction_sets() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (const std::int64_t target : targets())
      names.push_back(kernels::instruction_set_name(hwy::TargetName(target)));
    return names;
  }();
  return all;
}

void limit_instruction_set(std::string_view name) {
  if (name.empty()) return choose(0);
  std::string known;
  for (const std::int64_t target : targets()) {
    const std::string shown = kernels::instruction_set_name(hwy::TargetName(target));
    if (shown == name) return choose(target);
    known += (known.empty() ? "" : ", ") + shown;
  }
  throw InvalidSpec("no instruction set '" + std::string(name) + "' here; expected one of: " + known +
                    ", or nothing for the best");
}

}  // namespace broadside
#endif  // HWY_ONCE
