// broadside pairs --memory: a join that keeps boxes and pairs on disk.
#include "cli/out_of_core.hpp"

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "broadside/out_of_core.hpp"

#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/options.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/write_file.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/numbers.hpp"
#include "lab/pair_file.hpp"

namespace broadside::cli {
namespace {

/// How to read a file, for each pass.
struct FileToRead {
  std::string path;
  lab::ReadOptions options;
};

lab::BoxFile open(const FileToRead& file) {
  lab::ReadOptions options = file.options;
  // Rounding in the reader would not be counted.
  const bool is_rounded = options.precision == lab::Precision::float32;
  if (is_rounded) options.precision.reset();
  lab::BoxFile opened = lab::open_file(file.path, options);
  if (is_rounded)
    opened.frames = lab::with_precision(std::move(opened.frames), lab::Precision::float32, opened.name);
  return opened;
}

/// The boxes of a file's first frame, in pieces.
template <int D, typename Real>
class FileBoxes final : public BoxSource<D, Real> {
 public:
  FileBoxes(FileToRead file, bool leaves_out_touching)
      : file_(std::move(file)), leaves_out_touching_(leaves_out_touching) {
    open_again();
    estimated_ = reader().estimated_boxes();
  }

  void rewind() override {
    ++pass_;
    open_again();
  }

  bool next(std::vector<Box<D, Real>>& boxes) override {
    if (reader().first_piece(boxes)) {
      if (leaves_out_touching_) std::ranges::transform(boxes, boxes.begin(), half_open<D, Real>);
      return true;
    }
    if (pass_ != told_pass) return false;
    Step<D, Real> step;
    if (reader().next(step))
      say(fmt::format("{}: holds several frames; these are the pairs of the first", file_.path));
    say_lines(reader().warning());
    return false;
  }

  std::uint64_t estimated_size() const override { return estimated_; }

 private:
  lab::FrameReader<D, Real>& reader() {
    return *std::get<std::unique_ptr<lab::FrameReader<D, Real>>>(*frames_);
  }

  void open_again() {
    FileToRead file = file_;
    if (file.options.say_invalid && pass_ != told_pass) file.options.say_invalid = [](std::string_view) {};
    frames_.reset();
    frames_.emplace(open(file).frames);
  }

  // Only the second pass reports warnings about the file: the first one only samples the boxes, and the
  // second reads them all.
  static constexpr int told_pass = 2;

  FileToRead file_;
  bool leaves_out_touching_;
  std::optional<lab::AnyFrameReader> frames_;
  std::uint64_t estimated_ = 0;
  int pass_ = 0;
};

/// Throws unless the file can be read twice, within the memory limit.
void check_file(const std::string& path, const lab::BoxFile& file, std::uint64_t memory) {
  const bool is_regular = path != "-" && std::filesystem::is_regular_file(path);
  if (!is_regular || !lab::compression_extension_of(path).empty())
    throw Unusable(
        fmt::format("{}: is {} and --memory is given; expected a file that can be read again, and in "
                    "pieces",
                    file.name, is_regular ? "compressed" : "no regular file"));
  const bool has_pieces = std::visit([](const auto& frames) { return frames->has_pieces(); }, file.frames);
  const std::uint64_t bytes = std::filesystem::file_size(path);
  if (!has_pieces && bytes > memory / 4)
    throw Unusable(
        fmt::format("{}: has {} bytes in format {}, which is read as a whole; expected at most a quarter of "
                    "--memory, or .npy or .csv, which are read in pieces (broadside convert)",
                    file.name, lab::grouped(bytes), file.format->name));
}

/// Identifies a file together with its read options.
std::string identity_of(const FileToRead& file, const InputOptions& input) {
  const auto modified = std::chrono::file_clock::to_sys(std::filesystem::last_write_time(file.path));
  const auto second = std::chrono::floor<std::chrono::seconds>(modified);
  std::string text =
      fmt::format("{} of {} bytes, modified {:%Y-%m-%d %H:%M:%S}.{:09} UTC",
                  std::filesystem::absolute(file.path).string(), std::filesystem::file_size(file.path),
                  second, std::chrono::nanoseconds(modified - second).count());
  const auto add = [&text](std::string_view option, std::string_view value) {
    if (!value.empty()) text += fmt::format(" {} {}", option, value);
  };
  add("--format", input.format);
  add("--boxes", input.boxes);
  add("--array", input.array);
  add("--columns", input.columns);
  if (file.options.dimension != 0) add("--dimension", std::to_string(file.options.dimension));
  if (file.options.precision) add("--precision", lab::name(*file.options.precision));
  if (input.skips_invalid) text += " --skip-invalid";
  return text;
}

/// Beside the output or, without one, beside the first file.
std::filesystem::path work_folder_of(const PairsArguments& arguments) {
  if (!arguments.work.empty()) return arguments.work;
  const bool has_output = !arguments.counts && !lab::is_written_directly(arguments.output);
  return (has_output ? arguments.output : arguments.files[0]) + ".work";
}

/// The output must not lie in the work folder, which is removed, or holds only the join's own files.
void check_output(const PairsArguments& arguments, const std::filesystem::path& work) {
  if (arguments.counts || lab::is_written_directly(arguments.output)) return;
  const auto folder = std::filesystem::absolute(arguments.output).parent_path();
  if (std::filesystem::weakly_canonical(folder) == std::filesystem::weakly_canonical(work))
    throw Unusable(fmt::format("-o {} lies in the work folder {}; expected it elsewhere", arguments.output,
                               work.string()));
}

class JoinProgress {
 public:
  explicit JoinProgress(const std::filesystem::path& folder) : folder_(folder.string()) {}
  ~JoinProgress() { say_at_interruption(""); }
  JoinProgress(const JoinProgress&) = delete;
  JoinProgress& operator=(const JoinProgress&) = delete;

  void operator()(OutOfCoreStage stage, std::uint64_t done, std::uint64_t total) {
    if (stage != stage_) {
      stage_ = stage;
      line_.emplace();
      // All boxes may be read once more later, to repair a corrupt part.
      is_read_ |= stage != OutOfCoreStage::reading;
      say_at_interruption(fmt::format("{} is left, and the same command {}", folder_,
                                      is_read_ ? "resumes from it" : "starts over in it"));
    }
    if (!line_) line_.emplace();
    constexpr std::array<std::string_view, 3> texts = {"reading boxes", "joining parts", "writing pairs"};
    const std::string_view text = texts[static_cast<std::size_t>(stage)];
    if (total == 0 || done > total)
      line_->show(fmt::format("{}: {}", text, lab::grouped(done)));
    else
      line_->show(text, static_cast<double>(done) / static_cast<double>(total));
  }

  void clear() { line_.reset(); }

 private:
  std::string folder_;
  std::optional<ProgressLine> line_;
  std::optional<OutOfCoreStage> stage_;
  bool is_read_ = false;
};

template <int D, typename Real>
Exit join(const PairsArguments& arguments, std::vector<FileToRead> files, const OutOfCoreOptions& options,
          JoinProgress& progress) {
  const lab::Stopwatch watch;
  std::vector<std::unique_ptr<FileBoxes<D, Real>>> sources;
  for (FileToRead& file : files)
    sources.push_back(std::make_unique<FileBoxes<D, Real>>(std::move(file), arguments.leaves_out_touching));
  const bool is_between = sources.size() == 2;
  std::optional<OutOfCoreJoin<D, Real>> join;
  if (is_between)
    join.emplace(*sources[0], *sources[1], options);
  else
    join.emplace(*sources[0], options);
  if (join->is_resumed())
    say(fmt::format("{}: resumes the join that was interrupted", options.folder.string()));
  join->run();
  if (arguments.counts) {
    progress.clear();
    print(fmt::format("{}\n", join->pairs()));
    flush_output();
  } else {
    lab::write_file(arguments.output, [&](std::ostream& stream) {
      lab::PairFile file(stream, lab::pair_format_of(arguments.output, arguments.to), is_between, {},
                         join->has_large_ids());
      const auto visit_pairs = [&]<typename P>(const std::function<void(std::span<const P>)>& visit) {
        arguments.order == "sorted" ? join->visit_sorted(visit) : join->visit_unsorted(visit);
      };
      if (join->has_large_ids()) {
        std::vector<std::array<std::uint64_t, 2>> numbers;
        visit_pairs(std::function<void(std::span<const LargePair>)>([&](std::span<const LargePair> pairs) {
          numbers.clear();
          for (const LargePair pair : pairs) numbers.push_back({pair.first, pair.second});
          file.write(numbers);
        }));
      } else {
        visit_pairs(std::function<void(std::span<const Pair>)>(
            [&](std::span<const Pair> pairs) { file.write(pairs); }));
      }
      file.finish();
    });
    progress.clear();
  }
  const auto text = [](const std::string& path, std::uint64_t boxes) {
    return fmt::format("{} ({})", path, lab::counted(boxes, "box", "boxes"));
  };
  say(fmt::format("{}{} in {}D: {}, in {}; joined by {} in {} of memory in {}",
                  text(arguments.files[0], join->boxes()),
                  is_between ? " with " + text(arguments.files[1], join->right_boxes()) : "", D,
                  lab::counted(join->pairs(), "pair", "pairs"), lab::name(lab::precision_of<Real>),
                  options.algorithm, arguments.memory, lab::duration(watch.milliseconds() / 1e3)));
  join->remove_folder();
  return Exit::success;
}

}  // namespace

bool has_out_of_core() noexcept { return true; }

Exit join_out_of_core(const PairsArguments& arguments, const lab::Entry& entry) {
  OutOfCoreOptions options;
  options.folder = work_folder_of(arguments);
  check_output(arguments, options.folder);
  options.memory = read_memory(arguments.memory);
  options.algorithm = entry.spec.text();
  options.counts_only = arguments.counts;
  options.threads = Finder<2>(options.algorithm).workers().threads;
  std::vector<FileToRead> files;
  std::vector<int> dimensions;
  std::vector<lab::Precision> precisions;
  for (const std::string& path : arguments.files) {
    files.push_back({path, read_options(arguments.input, path)});
    files.back().options.progress = {};  // the join reports its own progress
    const lab::BoxFile file = open(files.back());
    check_file(path, file, options.memory);
    dimensions.push_back(lab::dimension_of(file.frames));
    precisions.push_back(lab::precision_of_frames(file.frames));
  }
  if (dimensions.front() != dimensions.back())
    throw Unusable(
        fmt::format("{} holds boxes in {}D and {} in {}D; expected both in the same, as --dimension 2 makes "
                    "them",
                    arguments.files[0], dimensions[0], arguments.files[1], dimensions[1]));
  if (precisions.front() != precisions.back())
    for (FileToRead& file : files) file.options.precision = lab::Precision::float64;
  for (const FileToRead& file : files)
    options.identity += (options.identity.empty() ? "" : " with ") + identity_of(file, arguments.input);
  if (arguments.leaves_out_touching) options.identity += " --no-touching";
  JoinProgress progress(options.folder);
  options.progress = std::ref(progress);
  options.warn = [&progress](std::string_view text) {
    progress.clear();
    say(text);
  };
  const lab::Precision precision =
      precisions.front() == precisions.back() ? precisions[0] : lab::Precision::float64;
  return lab::for_boxes_of(dimensions[0], precision, [&]<int D, typename Real>() {
    return join<D, Real>(arguments, std::move(files), options, progress);
  });
}

}  // namespace broadside::cli
