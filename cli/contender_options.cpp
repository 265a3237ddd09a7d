// Which algorithms a verb measures, and with how many threads: the options that compare and advise share.
#include "cli/contender_options.hpp"

#include <algorithm>

#include "cli/values.hpp"

namespace broadside::cli {

void add_algorithms(CLI::App& verb, ContenderOptions& options, const std::string& more) {
  verb.add_option(
          "--algorithms", options.algorithms,
          "Names, specs such as grid:cell=2.5, or the groups own, paper, peers, all; a comma between" + more)
      ->capture_default_str();
}

void add_threads(CLI::App& verb, ContenderOptions& options, const std::string& help) {
  verb.add_option("--threads", options.threads, help)->delimiter(',')->capture_default_str();
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
