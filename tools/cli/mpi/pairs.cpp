// broadside-mpi pairs: joins one file or two on all ranks. Each rank reads its slice, and rank 0 writes the
// pairs of all ranks in order.
#include "cli/mpi/pairs.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "broadside/mpi.hpp"

#include "cli/applicability.hpp"
#include "cli/help.hpp"
#include "cli/message.hpp"
#include "cli/mpi/ranks.hpp"
#include "cli/mpi/slices.hpp"
#include "cli/options.hpp"
#include "cli/pairs_arguments.hpp"
#include "lab/formats/write_file.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/numbers.hpp"
#include "lab/pair_file.hpp"

namespace broadside::cli {
namespace {

struct MpiPairsArguments : PairsArguments {
  bool hashes = false;
  bool has_statistics = false;

  bool writes() const { return !counts && !hashes; }
};

/// Sends the pairs of all ranks to rank 0, in rank order and in pieces. Rank 0 requests each piece, so that
/// it can stop if it cannot write.
class PairsOfRanks {
 public:
  explicit PairsOfRanks(std::span<const LargePair> own) : own_(own) {}

  /// On the other ranks: answers the requests of rank 0.
  void give() const {
    std::span<const LargePair> rest = own_;
    while (is_asked()) {
      const std::span<const LargePair> piece = rest.first(std::min(rest.size(), pairs_per_piece));
      const std::uint64_t size = piece.size();
      send(&size, sizeof(size), 0);
      send(piece.data(), piece.size_bytes(), 0);
      rest = rest.subspan(piece.size());
    }
  }

  /// On rank 0: calls take(pairs) with all pairs in order.
  template <typename Take>
  void take_all(const Take& take) {
    take(own_);
    for (; next_ < ranks(); ++next_) take_those_of(next_, take);
  }

  /// On rank 0, at the end: releases the ranks that still wait for a request.
  void let_go() {
    for (; next_ < ranks(); ++next_) ask(next_, false);
  }

 private:
  static constexpr std::size_t pairs_per_piece = std::size_t{1} << 18;

  static bool is_asked() {
    char is_wanted = 0;
    receive(&is_wanted, 1, 0);
    return is_wanted != 0;
  }

  static void ask(int of, bool is_wanted) {
    const char byte = is_wanted ? 1 : 0;
    send(&byte, 1, of);
  }

  template <typename Take>
  static void take_those_of(int from, const Take& take) {
    std::vector<LargePair> pairs(pairs_per_piece);
    for (std::uint64_t size = 1; size > 0;) {
      ask(from, true);
      receive(&size, sizeof(size), from);
      receive(pairs.data(), size * sizeof(LargePair), from);
      take(std::span<const LargePair>(pairs).first(static_cast<std::size_t>(size)));
    }
    ask(from, false);
  }

  std::span<const LargePair> own_;
  int next_ = 1;
};

void write(std::span<const LargePair> pairs, bool has_large_ids, lab::PairFile& file) {
  constexpr std::size_t pairs_per_piece = std::size_t{1} << 14;
  std::vector<Pair> small;
  std::vector<std::array<std::uint64_t, 2>> large;
  while (!pairs.empty()) {
    const std::span<const LargePair> piece = pairs.first(std::min(pairs.size(), pairs_per_piece));
    pairs = pairs.subspan(piece.size());
    small.clear();
    large.clear();
    for (const LargePair pair : piece) {
      if (has_large_ids)
        large.push_back({pair.first, pair.second});
      else
        small.push_back(
            {BoxId(static_cast<std::uint32_t>(pair.first)), BoxId(static_cast<std::uint32_t>(pair.second))});
    }
    has_large_ids ? file.write(large) : file.write(small);
  }
}

/// Rank 0 writes. If it cannot, all ranks throw.
void write_all(const MpiPairsArguments& arguments, std::span<const LargePair> own, bool has_large_ids) {
  PairsOfRanks pairs(own);
  on_all([&] {
    if (rank() != 0) {
      pairs.give();
      return;
    }
    try {
      lab::write_file(arguments.output, [&](std::ostream& stream) {
        lab::PairFile file(stream, lab::pair_format_of(arguments.output, arguments.to),
                           arguments.files.size() == 2, {}, has_large_ids);
        pairs.take_all([&](std::span<const LargePair> some) { write(some, has_large_ids, file); });
        file.finish();
      });
    } catch (...) {
      pairs.let_go();
      throw;
    }
  });
}

std::string statistics_text(const mpi::Summary& summary) {
  const auto a_box = [&](std::uint64_t bytes) {
    return summary.all.boxes == 0 ? 0 : static_cast<double>(bytes) / static_cast<double>(summary.all.boxes);
  };
  return fmt::format(
      "{}: {:.2f} bytes sent a box, and {:.2f} for pairs; {:.2f} % of the boxes in several parts; the rank "
      "with "
      "the most has {:.3f} of the mean work, {:.3f} of the boxes and {:.3f} of the pairs",
      lab::counted(static_cast<std::uint64_t>(ranks()), "rank", "ranks"), a_box(summary.all.box_bytes),
      a_box(summary.all.pair_bytes), 100 * (std::max(a_box(summary.all.part_boxes), 1.0) - 1),
      summary.largest_over_mean_work, summary.largest_over_mean_boxes, summary.largest_over_mean_pairs);
}

template <int D, typename Real>
Exit join(const MpiPairsArguments& arguments, std::vector<SlicedFile>& files, const std::string& spec) {
  const lab::Stopwatch read_watch;
  std::vector<std::vector<Box<D, Real>>> sets;
  for (SlicedFile& file : files) sets.push_back(read_slice<D, Real>(file));
  const double read_ms = read_watch.milliseconds();
  const lab::Stopwatch watch;
  std::vector<LargePair> pairs;
  std::uint64_t hash_of_own = 0;
  mpi::RankStatistics statistics;
  on_all([&] {
    const auto take = [&](std::span<const LargePair> some) {
      if (arguments.writes()) pairs.insert(pairs.end(), some.begin(), some.end());
      if (arguments.hashes)
        for (const LargePair& pair : some) hash_of_own += hash(pair);
    };
    const mpi::Options options{.algorithm = spec};
    statistics = sets.size() == 1 ? mpi::find_pairs(MPI_COMM_WORLD, sets[0], take, options)
                                  : mpi::find_pairs(MPI_COMM_WORLD, sets[0], sets[1], take, options);
  });
  const double join_ms = watch.milliseconds();
  const std::uint64_t count = sum_of_ranks(statistics.pairs);
  const std::uint64_t hash = sum_of_ranks(hash_of_own);
  std::vector<std::uint64_t> boxes;
  for (const auto& set : sets) boxes.push_back(sum_of_ranks(set.size()));
  if (arguments.writes())
    write_all(arguments, pairs, std::ranges::max(boxes) > std::uint64_t{UINT32_MAX} + 1);
  const mpi::Summary summary = mpi::summary(MPI_COMM_WORLD, statistics);
  on_all([&] {
    if (rank() != 0) return;
    if (arguments.counts) print(fmt::format("{}\n", count));
    if (arguments.hashes) print(fmt::format("{:016x}\n", hash));
    flush_output();
    std::string text;
    for (std::size_t set = 0; set < sets.size(); ++set)
      text += fmt::format("{}{} ({})", set == 0 ? "" : " with ", arguments.files[set],
                          lab::counted(boxes[set], "box", "boxes"));
    say(fmt::format("{} in {}D: {}, in {}; read in {}, joined by {} on {} in {}", text, D,
                    lab::counted(count, "pair", "pairs"), lab::name(lab::precision_of<Real>),
                    lab::duration(read_ms / 1e3), spec,
                    lab::counted(static_cast<std::uint64_t>(ranks()), "rank", "ranks"),
                    lab::duration(join_ms / 1e3)));
    if (arguments.has_statistics) say(statistics_text(summary));
  });
  return Exit::success;
}

void check_match(const std::vector<SlicedFile>& files) {
  if (files.front().dimension != files.back().dimension)
    throw Unusable(
        fmt::format("{} holds boxes in {}D and {} in {}D; expected both in the same, as --dimension 2 makes "
                    "them",
                    files.front().path, files.front().dimension, files.back().path, files.back().dimension));
}

Exit run(const MpiPairsArguments& arguments, const CLI::App& verb, const lab::Catalogue& catalogue) {
  std::vector<SlicedFile> files;
  std::string spec;
  on_all([&] {
    check_alone(verb, "--hash", {"--output", "--to"}, "which writes no pairs");
    check(arguments, catalogue);
    spec = entry_of(arguments, catalogue).spec.text();
    for (const std::string& path : arguments.files)
      files.emplace_back(path, read_options(arguments.input, path));
  });
  for (SlicedFile& file : files) look_at(file);
  on_all([&] { check_match(files); });
  const lab::Precision precision =
      files.front().precision == files.back().precision ? files.front().precision : lab::Precision::float64;
  return lab::for_boxes_of(files.front().dimension, precision,
                           [&]<int D, typename Real>() { return join<D, Real>(arguments, files, spec); });
}

}  // namespace

Verb add_mpi_pairs(CLI::App& program, const lab::Catalogue& catalogue) {
  const auto arguments = std::make_shared<MpiPairsArguments>();
  CLI::App* const verb =
      program.add_subcommand("pairs",
                             "Finds the pairs of overlapping boxes of a file, or between the boxes of two "
                             "files, by all ranks: the pairs of "
                             "`broadside pairs`, byte for byte, for any number of ranks. Each rank reads its "
                             "slice of .npy and .csv files; "
                             "others, compressed ones and standard input are read by rank 0 and sent out.");
  verb->add_option("files", arguments->files, "A file, or two; - is standard input")->required();
  add_input_options(*verb, arguments->input);
  verb->add_option(
          "--algorithm,--algorithms", arguments->algorithm,
          "Name or spec such as grid:cell=2.5, by which each rank searches its part of space; it affects "
          "the time, not the pairs")
      ->capture_default_str();
  verb->add_option("--threads", arguments->threads,
                   "Threads of each rank (0: as many as the machine has, or as mpirun binds a rank to; "
                   "default: the spec's, or 1)");
  verb->add_option(
          "-o,--output", arguments->output,
          "A .csv file with a pair a line, or an .npy file of n x 2 numbers, which rank 0 writes; - is "
          "standard output, as CSV unless --to says otherwise")
      ->capture_default_str();
  verb->add_option("--to", arguments->to, "csv or npy, whatever the extension")->type_name("NAME");
  verb->add_flag("--count", arguments->counts, "Only count the pairs");
  verb->add_flag("--hash", arguments->hashes,
                 "Only print a hash of the set of pairs, with which two runs can be compared");
  verb->add_flag("--statistics", arguments->has_statistics,
                 "Also say on stderr how many bytes were sent a box, and how evenly ranks shared the work");
  add_examples(*verb, {{"pairs boxes.npy -o pairs.npy", "after mpirun -n 4: by four ranks"},
                       {"pairs left.csv right.csv --count --statistics",
                        "counts, and says how ranks shared the work"}});
  return [arguments, verb, &catalogue] { return run(*arguments, *verb, catalogue); };
}

}  // namespace broadside::cli
