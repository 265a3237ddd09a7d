// The tunables that several algorithms share.
#include "core/tunables.hpp"

namespace broadside::core {

Tunable threads_tunable() {
  return {.name = "threads",
          .summary = "maximum number of threads of a search; 0: all available",
          .default_value = "1",
          .type = Tunable::Type::integer,
          .min = 0,
          .max = 1024};
}

Tunable update_tunable() {
  return {.name = "update",
          .summary = "for tracking only: follow the boxes that changed, or find all pairs anew in each frame",
          .default_value = "auto",
          .type = Tunable::Type::choice,
          .choices = {"follow", "rebuild"}};
}

Update update_of(const Settings& settings) {
  if (settings.is_auto("update")) return Update::automatic;
  return settings.text("update") == "follow" ? Update::follow : Update::rebuild;
}

}  // namespace broadside::core
