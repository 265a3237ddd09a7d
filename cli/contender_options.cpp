// Which algorithms a verb measures, and with how many threads: the options that compare and advise share.
#include "cli/contender_options.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "cli/unusable.hpp"
#include "cli/values.hpp"

namespace broadside::cli {

CLI::Option* add_algorithms(CLI::App& verb, std::string& list, const std::string& help) {
  return verb.add_option("--algorithms,--algorithm", list, help)
      ->join(',')
      ->type_name("LIST")
      ->capture_default_str();
}

void add_threads(CLI::App& verb, ContenderOptions& options, const std::string& help) {
  verb.add_option("--threads", options.threads, help)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NUMBERS")
      ->default_str("1");
}

void check_threads(const ContenderOptions& options, std::span<const lab::Contender> contenders) {
  const std::vector<std::size_t> threads = threads_of(options);
  const auto can_use = [&threads](const lab::Contender& contender) {
    const std::vector<lab::Contender> with = lab::with_threads({contender}, threads);
    return with.size() != 1 || with.front().spec.text() != contender.spec.text();
  };
  const bool is_one = threads == std::vector<std::size_t>{1};
  if (!is_one && std::ranges::none_of(contenders, can_use))
    throw Unusable(
        fmt::format("--threads is '{}' with --algorithms {}; expected an algorithm that can use several "
                    "and does not say how many",
                    fmt::join(options.threads, ","), options.algorithms));
}

std::vector<std::size_t> threads_of(const ContenderOptions& options) {
  std::vector<std::size_t> numbers;
  for (const std::string& text : options.threads) {
    const std::size_t threads = read_threads(text);
    if (std::ranges::find(numbers, threads) == numbers.end()) numbers.push_back(threads);
  }
  return numbers;
}

}  // namespace broadside::cli
