// broadside pairs: joins one file or two, and writes the pairs of overlapping boxes.
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "broadside/algorithm.hpp"
#include "broadside/batch.hpp"
#include "broadside/components.hpp"
#include "broadside/filter.hpp"
#include "broadside/keys.hpp"
#include "broadside/sinks.hpp"
#include "broadside/within.hpp"

#include "cli/applicability.hpp"
#include "cli/help.hpp"
#include "cli/message.hpp"
#include "cli/options.hpp"
#include "cli/out_of_core.hpp"
#include "cli/pairs_arguments.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"
#include "lab/catalogue.hpp"
#include "lab/formats/mesh/swept_mesh.hpp"
#include "lab/formats/write_file.hpp"
#include "lab/join.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/numbers.hpp"
#include "lab/pair_file.hpp"

namespace broadside::cli {
namespace {

/// The frame to read, counted from 0.
std::size_t frame_of(const PairsArguments& arguments) {
  return arguments.frame.empty() ? 0 : read_index("--frame", arguments.frame);
}

/// The column or property that read() takes from a file: the ids to write or, without --ids, the keys; empty
/// without both.
const std::string& labels_column(const PairsArguments& arguments, std::size_t file) {
  if (!arguments.ids.empty()) return arguments.ids[std::min(file, arguments.ids.size() - 1)];
  return arguments.same.empty() ? arguments.different : arguments.same;
}

/// Which rows of tables may be boxes across the date line. With --longitude these are all rows. Otherwise
/// they are the rows of tables whose columns have names of longitudes, if space can repeat.
lab::DateLine date_line_of(const PairsArguments& arguments, const lab::Entry& entry) {
  if (arguments.is_longitude) return lab::DateLine::always;
  const bool can_repeat = find_algorithm(entry.spec.name) != nullptr && !takes_all_frames(arguments) &&
                          arguments.period.empty() && (arguments.within.empty() || arguments.is_euclidean) &&
                          !arguments.leaves_out_touching;
  return can_repeat ? lab::DateLine::by_names : lab::DateLine::none;
}

/// Reads one frame of a file, with its ids or, without --ids, its keys; or all frames.
lab::FrameOfFile read(const PairsArguments& arguments, std::size_t file, lab::DateLine date_line,
                      lab::Rounding& rounding) {
  const std::string& path = arguments.files[file];
  lab::ReadOptions options = read_options(arguments.input, path);
  options.ids = labels_column(arguments, file);
  options.date_line = date_line;
  // Round once the frame is read instead, where the rounding is counted.
  const bool is_rounded = options.precision == lab::Precision::float32;
  if (is_rounded) options.precision.reset();
  lab::BoxFile opened = lab::open_file(path, options);
  lab::FrameOfFile read = takes_all_frames(arguments)
                              ? lab::read_all_frames(std::move(opened))
                              : lab::read_frame(std::move(opened), frame_of(arguments));
  say_lines(read.warning);
  if (read.is_moving && arguments.frame.empty())
    say(fmt::format("{}: holds several frames; these are the pairs of the first (--frame 0)", read.name));
  if (is_rounded) rounding += lab::round_to_float(read.boxes);
  return read;
}

/// The keys in a column of the boxes that read() gave. Throws FileError if a box has none.
std::vector<std::string> keys_of(const PairsArguments& arguments, const std::string& column, std::size_t file,
                                 const lab::FrameOfFile& boxes) {
  std::shared_ptr<const lab::BoxLabels> labels = boxes.labels;
  if (column != labels_column(arguments, file)) {
    lab::ReadOptions options = read_options(arguments.input, arguments.files[file]);
    options.ids = column;
    options.date_line = lab::DateLine::always;  // read() has refused what is invalid
    labels = lab::read_frame(lab::open_file(arguments.files[file], options), frame_of(arguments)).labels;
  }
  std::vector<std::string> keys = labels->ids;
  keys.resize(lab::size(boxes.boxes));
  const auto missing = std::ranges::find(keys, std::string());
  if (missing != keys.end())
    throw lab::FileError(fmt::format("{}: box {} has no '{}'; expected a key for each box", boxes.name,
                                     missing - keys.begin(), column));
  return keys;
}

/// The pairs within one set of boxes or between two sets, from files or from the parts of a swept mesh.
class PairsCommand {
 public:
  PairsCommand(const PairsArguments& arguments, const lab::Catalogue& catalogue)
      : arguments_(arguments), entry_(entry_of(arguments, catalogue)) {
    const lab::Stopwatch watch;
    if (arguments.is_swept) {
      sweep();
    } else {
      for (std::size_t file = 0; file < arguments.files.size(); ++file)
        sets_.push_back(read(arguments, file, date_line_of(arguments, entry_), rounding_));
      if (is_between()) lab::match(sets_[0], sets_[1]);
      take_keys();
    }
    take_longitude();
    // Not before both sets have the same precision: the next lower float is not the next lower double.
    if (arguments.leaves_out_touching) {
      for (lab::FrameOfFile& set : sets_)
        std::visit(
            [](auto& boxes) {
              std::ranges::transform(boxes, boxes.begin(), [](const auto& box) { return half_open(box); });
            },
            set.boxes);
    }
    read_ms_ = watch.milliseconds();
  }

  bool is_between() const { return sets_.size() == 2; }

  /// Shows the number of pairs so far; the total is not known.
  void show(std::uint64_t pairs) {
    constexpr std::uint64_t pairs_per_report = std::uint64_t{1} << 20;
    if (pairs - shown_pairs_ < pairs_per_report) return;
    shown_pairs_ = pairs;
    progress_.show(
        fmt::format("joining by {}: {}", entry_.spec.text(), lab::counted(pairs, "pair", "pairs")));
  }

  std::size_t boxes() const { return lab::size(sets_[0].boxes); }

  /// The ids to write instead of numbers, if requested.
  lab::PairIds ids() const {
    if (arguments_.ids.empty()) return {};
    return {&sets_.front().labels->ids, &sets_.back().labels->ids};
  }

  /// Writes the pairs in the order in which they are found.
  void find(PairSink& pairs) {
    const lab::Stopwatch watch;
    if (!different_.empty()) {
      auto different = only_different(different_.front(), different_.back(), pairs);
      search(different);
    } else if (elements_.empty()) {
      search(pairs);
    } else {
      lab::ApartPairs apart(elements_.front(), elements_.back(), pairs);
      search(apart);
      pairs.flush();
    }
    join_ms_ = watch.milliseconds();
    progress_.clear();
  }

  /// The pairs of every frame, those of each in the order in which they are found.
  BatchPairs find_in_frames() {
    const lab::Stopwatch watch;
    BatchPairs found = std::visit(
        [this](const auto& boxes) {
          return find_pairs_batch(boxes, sets_[0].offsets, {.algorithm = entry_.spec});
        },
        sets_[0].boxes);
    join_ms_ = watch.milliseconds();
    return found;
  }

  /// Summary of the join: inputs, algorithm and time.
  std::string text(const std::string& found) const {
    std::string sets;
    if (arguments_.is_swept) sets = fmt::format("{} to {}: ", arguments_.files[0], arguments_.files[1]);
    std::string_view separator;
    for (const lab::FrameOfFile& set : sets_) {
      const std::size_t absent = lab::absent_count(set.boxes);
      sets += fmt::format(
          "{}{} ({}{}{})", separator, set.name, lab::counted(lab::size(set.boxes), "box", "boxes"),
          set.offsets.empty() ? "" : " in " + lab::counted(set.offsets.size() - 1, "frame", "frames"),
          absent > 0 ? fmt::format(", {} of them absent", lab::grouped(absent)) : "");
      separator = " with ";
    }
    return fmt::format(
        "{} in {}D: {}{}{}{}, {}; read in {}, joined by {} in {}", sets, lab::dimension(sets_[0].boxes),
        found,
        arguments_.within.empty()
            ? ""
            : fmt::format(" within {}{}", arguments_.within, arguments_.is_euclidean ? " (Euclidean)" : ""),
        period_.empty() ? "" : fmt::format(" with period {}", period_),
        arguments_.leaves_out_touching ? ", without pairs that only touch" : "", precision_text(),
        lab::duration(read_ms_ / 1e3), entry_.spec.text(), lab::duration(join_ms_ / 1e3));
  }

 private:
  void sweep() {
    const std::vector<std::string>& files = arguments_.files;
    const lab::ReadOptions options = read_options(arguments_.input);
    const lab::SweptMesh mesh = lab::read_swept_mesh(files[0], files[1], options);
    const bool is_float = options.precision.value_or(mesh.precision()) == lab::Precision::float32;
    const auto add = [&](const std::string& part) {
      lab::SweptElements swept = mesh.swept(read_part("", part));
      sets_.push_back(
          {.name = part, .boxes = std::move(swept.boxes), .importer = std::string(mesh.importer())});
      if (is_float) rounding_ += lab::round_to_float(sets_.back().boxes);
      if (arguments_.excludes_shared) elements_.push_back(std::move(swept.elements));
    };
    add(arguments_.left);
    if (arguments_.right != arguments_.left) add(arguments_.right);
  }

  /// Longitude repeats if the user says so, or if a table has boxes across the date line.
  void take_longitude() {
    if (!period_.empty()) return;
    const std::string period = lab::dimension(sets_[0].boxes) == 2 ? "360,-" : "360,-,-";
    if (arguments_.is_longitude) period_ = period;
    for (const lab::FrameOfFile& set : sets_) {
      const std::size_t across = set.labels == nullptr ? 0 : set.labels->across_date_line;
      if (across == 0 || arguments_.is_longitude) continue;
      period_ = period;
      say(fmt::format("{}: {} across the date line, so longitude repeats, as with --longitude", set.name,
                      lab::counted(across, "box is", "boxes are")));
    }
  }

  void take_keys() {
    const auto keys = [this](const std::string& column, std::size_t file) {
      return keys_of(arguments_, column, file, sets_[file]);
    };
    const bool are_same = !arguments_.same.empty();
    const bool are_different = !arguments_.different.empty();
    if (are_same || are_different) {
      const KeyRule rule = are_same ? KeyRule::same : KeyRule::different;
      const std::string& column = are_same ? arguments_.same : arguments_.different;
      const std::vector<std::string> left = keys(column, 0);
      if (is_between())
        std::tie(filters_, right_filters_) = filters_of_keys(rule, left, keys(column, 1));
      else
        filters_ = filters_of_keys(rule, left);
    }
    for (std::size_t file = 0; are_same && are_different && file < sets_.size(); ++file)
      different_.push_back(keys(arguments_.different, file));
  }

  /// The precision in which the pairs are exact, or how many coordinates were rounded.
  std::string precision_text() const {
    const std::string_view precision = name(lab::precision(sets_[0].boxes));
    const auto imported =
        std::ranges::find_if(sets_, [](const lab::FrameOfFile& set) { return !set.importer.empty(); });
    const bool is_computed = std::ranges::any_of(sets_, &lab::FrameOfFile::is_computed);
    if (imported == sets_.end() && rounding_.rounded == 0 && !is_computed)
      return fmt::format("exact in {}", precision);
    std::string text = fmt::format("in {}", precision);
    if (rounding_.rounded > 0)
      text += fmt::format(", to which {} of {} were rounded", lab::grouped(rounding_.rounded),
                          lab::counted(rounding_.coordinates, "coordinate", "coordinates"));
    if (imported != sets_.end())
      text += fmt::format(", of coordinates that {} reads as floats", imported->importer);
    if (is_computed) text += ", of bounds computed from centres or sizes";
    return text;
  }

  void search(PairSink& pairs) {
    const PairFilters filters{filters_, right_filters_};
    if (arguments_.is_euclidean || !period_.empty()) return search_around(pairs, filters);
    if (!arguments_.within.empty()) {
      const double distance = read_distance(arguments_.within);
      if (is_between())
        lab::join_within(sets_[0].boxes, sets_[1].boxes, distance, entry_, pairs, filters);
      else
        lab::join_within(sets_[0].boxes, distance, entry_, pairs, filters);
      return;
    }
    if (is_between())
      lab::join(sets_[0].boxes, sets_[1].boxes, entry_, pairs, filters);
    else
      lab::join(sets_[0].boxes, entry_, pairs, filters);
  }

  /// The pairs within a Euclidean distance, which may be 0, in space that may repeat.
  void search_around(PairSink& pairs, const PairFilters& filters) {
    const std::vector<double> periods = read_periods(period_);
    Reach reach = arguments_.within.empty() ? 0 : read_distance(arguments_.within);
    if (!periods.empty()) reach = reach.periodic(periods);
    const FindOptions options{
        .algorithm = entry_.spec, .filters = filters.filters, .right_filters = filters.right_filters};
    std::visit(
        [&](const auto& boxes) {
          if (is_between())
            find_pairs_within(boxes, std::get<std::decay_t<decltype(boxes)>>(sets_[1].boxes), reach, pairs,
                              options);
          else
            find_pairs_within(boxes, reach, pairs, options);
        },
        sets_[0].boxes);
  }

  const PairsArguments& arguments_;
  lab::Entry entry_;
  std::string period_ = arguments_.period;
  std::vector<lab::FrameOfFile> sets_;
  std::vector<lab::MeshElements> elements_;  // of each set, if pairs with a shared vertex are left out
  std::vector<Filter> filters_;              // of keys
  std::vector<Filter> right_filters_;
  std::vector<std::vector<std::string>> different_;  // keys of each set, if the filters are of other keys
  lab::Rounding rounding_;
  ProgressLine progress_;
  std::uint64_t shown_pairs_ = 0;
  double read_ms_ = 0;
  double join_ms_ = 0;
};

void write_all(std::span<const Pair> pairs, lab::PairFile& file) {
  constexpr std::size_t pairs_per_report = std::size_t{1} << 16;
  ProgressLine progress;
  for (std::size_t begin = 0; begin < pairs.size(); begin += pairs_per_report) {
    progress.show("writing pairs", static_cast<double>(begin) / static_cast<double>(pairs.size()));
    file.write(pairs.subspan(begin, std::min(pairs_per_report, pairs.size() - begin)));
  }
}

/// "1 pair".
std::string counted_pairs(std::uint64_t pairs) { return lab::counted(pairs, "pair", "pairs"); }

/// Writes a line for each box: itself, and the first box of its component.
void write_components(PairsCommand& join, const PairsArguments& arguments) {
  Components components(join.boxes());
  join.find(components);
  const std::vector<BoxId> labels = components.labels();
  std::vector<Pair> rows;
  std::size_t count = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    rows.push_back({BoxId(i), labels[i]});
    if (labels[i] == i) ++count;
  }
  lab::write_file(arguments.output, [&](std::ostream& stream) {
    lab::PairFile file(stream, lab::pair_format_of(arguments.output, arguments.to), false, join.ids(), false,
                       "box,component\n");
    file.write(rows);
    file.finish();
  });
  say(join.text(lab::counted(count, "component", "components")));
}

/// Writes a line for each pair of each frame, with the frame's number.
void write_pairs_of_frames(PairsCommand& join, const PairsArguments& arguments) {
  BatchPairs found = join.find_in_frames();
  const std::size_t frames = found.offsets.size() - 1;
  if (arguments.order == "sorted") {
    for (std::size_t frame = 0; frame < frames; ++frame)
      std::sort(found.pairs.data() + found.offsets[frame], found.pairs.data() + found.offsets[frame + 1]);
  }
  if (arguments.counts) {
    print(fmt::format("{}\n", found.pairs.size()));
    flush_output();
  } else {
    lab::write_file(arguments.output, [&](std::ostream& stream) {
      lab::PairFile file(stream, lab::pair_format_of(arguments.output, arguments.to), false, {}, false,
                         "frame,first,second\n", 3);
      for (std::size_t frame = 0; frame < frames; ++frame) file.write(frame, found.of(frame));
      file.finish();
    });
  }
  say(join.text(counted_pairs(found.pairs.size())));
}

Exit run(const PairsArguments& arguments, const CLI::App& verb, const lab::Catalogue& catalogue) {
  check_alone(verb, "--count", {"--order", "--to"}, "which writes no pairs");
  check_keys(verb, arguments);
  check_components(verb, arguments);
  if (takes_all_frames(arguments))
    check_alone(
        verb, "--frame",
        {"--ids", "--same", "--different", "--components", "--within", "--period", "--longitude", "--memory"},
        "which only finds the overlapping boxes of each frame");
  check(arguments, catalogue);
  if (!arguments.memory.empty()) return join_out_of_core(arguments, entry_of(arguments, catalogue));
  PairsCommand join(arguments, catalogue);
  if (arguments.finds_components) {
    write_components(join, arguments);
    return Exit::success;
  }
  if (takes_all_frames(arguments)) {
    write_pairs_of_frames(join, arguments);
    return Exit::success;
  }
  if (arguments.counts) {
    PairCounter counter;
    join.find(counter);
    print(fmt::format("{}\n", counter.count()));
    flush_output();
    say(join.text(counted_pairs(counter.count())));
    return Exit::success;
  }
  const bool streams = arguments.order == "found";
  std::vector<Pair> sorted;
  if (!streams) {
    PairFunction collector([&](std::span<const Pair> pairs) {
      sorted.insert(sorted.end(), pairs.begin(), pairs.end());
      join.show(sorted.size());
    });
    join.find(collector);
    std::sort(sorted.begin(), sorted.end());
  }
  std::uint64_t count = sorted.size();
  lab::write_file(arguments.output, [&](std::ostream& stream) {
    lab::PairFile file(stream, lab::pair_format_of(arguments.output, arguments.to), join.is_between(),
                       join.ids());
    if (streams) {
      PairFunction found([&](std::span<const Pair> pairs) {
        count += pairs.size();
        file.write(pairs);
        join.show(count);
      });
      join.find(found);
    } else {
      write_all(sorted, file);
    }
    file.finish();
  });
  say(join.text(counted_pairs(count)));
  return Exit::success;
}

}  // namespace

Verb add_pairs(CLI::App& program, const lab::Catalogue& catalogue) {
  const auto arguments = std::make_shared<PairsArguments>();
  CLI::App* const verb = program.add_subcommand(
      "pairs",
      "Finds the pairs of overlapping boxes of a file, or between the boxes of two files, exactly in "
      "the precision of the input; where coordinates had to be rounded, it says so. Boxes are counted from "
      "0.");
  verb->add_option("files", arguments->files, "A file, or two; - is standard input")->required();
  add_input_options(*verb, arguments->input);
  verb->add_option(
          "--ids", arguments->ids,
          "Write the boxes' ids instead of their numbers: a table's column, or a map's property (id is "
          "a feature's own); given twice, for the one file and the other")
      ->type_name("NAME")
      ->allow_extra_args(false);
  verb->add_option(
          "--within", arguments->within,
          "Find the pairs of boxes with a gap of at most this on each axis: all within that distance, and "
          "a few past corners, which --euclidean leaves out")
      ->type_name("DISTANCE");
  verb->add_flag("--euclidean", arguments->is_euclidean,
                 "With --within: measure the distance in a straight line, also past corners, instead of "
                 "on each axis");
  verb->add_option(
          "--period", arguments->period,
          "Space repeats after these lengths, one for each axis, - for an axis on which it does not: "
          "360,- for longitude and latitude. Boxes also pair around the edge; --within is then "
          "measured in a straight line and needs --euclidean")
      ->type_name("LENGTHS");
  verb->add_flag(
      "--longitude", arguments->is_longitude,
      "The first axis is in degrees of longitude: space repeats after 360, and a table's row from 170 to "
      "-170 is a box across the date line. Such rows are read so without this option if the names of "
      "their columns contain lon or lng");
  verb->add_flag(
      "--no-touching", arguments->leaves_out_touching,
      "Leave out pairs of boxes that only touch. Boxes are half-open (min <= p < max); a point or line "
      "on a border belongs to the box that begins there");
  verb->add_option(
          "--same", arguments->same,
          "Find only pairs of boxes with the same key, such as an image or a class. NAME is a table's "
          "column or a map's property")
      ->type_name("NAME");
  verb->add_option(
          "--different", arguments->different,
          "Find only pairs of boxes with different keys; NAME as for --same. With both options, a pair "
          "must meet both conditions")
      ->type_name("NAME");
  verb->add_flag(
      "--components", arguments->finds_components,
      "Instead of pairs, write each box with the first box of its connected component, such as a cluster "
      "of boxes that touch. No pairs are kept");
  verb->add_option("--algorithm,--algorithms", arguments->algorithm,
                   "Name or spec such as grid:cell=2.5; it affects the time, not the pairs")
      ->capture_default_str();
  verb->add_option("--threads", arguments->threads,
                   "Threads to search with (0: as many as the machine has; default: the spec's, or 1); they "
                   "affect the time alone");
  verb->add_option("--frame", arguments->frame,
                   "Which frame to search in a file whose boxes move, counted from 0 (default: the first). "
                   "'all' searches every frame, and writes its number before each pair; all frames are held "
                   "in memory");
  verb->add_option(
          "-o,--output", arguments->output,
          "A .csv file with a pair a line, or an .npy file of n x 2 numbers (n x 3 with --frame all); "
          "- is standard output, as CSV unless --to says otherwise")
      ->capture_default_str();
  verb->add_option("--to", arguments->to, "csv or npy, whatever the extension")->type_name("NAME");
  verb->add_option("--order", arguments->order,
                   "sorted: by the first box, then the second, whatever the algorithm (takes 8 bytes a "
                   "pair); found: written as they are found, in an order fixed by boxes and algorithm")
      ->capture_default_str();
  verb->add_flag("--count", arguments->counts, "Only count the pairs, and keep none");
  verb->add_option(
          "--memory", arguments->memory,
          "Take no more memory than this, such as 2G: boxes and pairs are kept in a work folder and joined "
          "part after part. If that ends early, by whatever cause, the same command goes on where it was")
      ->type_name("SIZE");
  verb->add_option(
          "--work", arguments->work,
          "With --memory: the work folder (default: the output's name, or the first file's, with .work), "
          "which is removed in the end")
      ->type_name("FOLDER");
  verb->add_flag("--swept", arguments->is_swept,
                 "The two files are one mesh at two times: join the boxes that its parts sweep in between");
  verb->add_option("--left", arguments->left, "With --swept: vertices, edges or faces")->type_name("PART");
  verb->add_option("--right", arguments->right,
                   "Likewise; where both are the same part, each pair is found once")
      ->type_name("PART");
  verb->add_flag("--exclude-shared", arguments->excludes_shared,
                 "With --swept: leave out pairs that have a vertex in common");
  add_examples(
      *verb,
      {{"pairs boxes.csv -o pairs.csv", "which boxes of a file overlap"},
       {"pairs buildings.geojson roads.csv --count", "how many boxes of one file overlap one of the other"},
       {"pairs detections.csv --same image -o pairs.csv", "which boxes of the same image overlap"},
       {"pairs buildings.geojson --components", "which buildings form a cluster"},
       {"pairs boxes.npy --memory 2G --threads 0 -o pairs.npy",
        "the same for more boxes than memory holds"}});
  return [arguments, verb, &catalogue] { return run(*arguments, *verb, catalogue); };
}

}  // namespace broadside::cli
