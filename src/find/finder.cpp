// Finder: checks boxes before it searches, and delivers the pairs.
#include "broadside/finder.hpp"

#include <array>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"

#include "algorithms/registry.hpp"
#include "core/float_environment.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"
#include "find/deliver.hpp"
#include "find/search.hpp"

namespace broadside {
template <int D, typename Real>
class BROADSIDE_HIDDEN Finder<D, Real>::State {
 public:
  State(find::Searchers<D> searchers, std::size_t threads)
      : workers{.threads = threads}, search_(std::move(searchers)) {}

  std::optional<Statistics> find(BoxView<D, Real> view, PairSink& pairs, const PairFilters& filters) {
    const core::DefaultEnvironment environment;
    core::check_count(view.size());
    find::check_filters(filters, view.size());
    std::span<const Box<D, Real>> boxes = find::array_of(view, gathered_[0]);
    // Checked before boxes become half-open, so that messages show the caller's numbers.
    std::size_t absent = touching ? 0 : check(boxes, false);
    if (!touching) boxes = find::half_open_boxes(boxes, gathered_[0]);
    const bool are_rounded = search_.round(boxes, workers);
    if (touching) absent = check(boxes, are_rounded);
    return find::deliver(environment, pairs, [&](PairSink& sink) {
      return search_.find(boxes, {filters, workers, nullptr, absent, are_rounded}, sink);
    });
  }

  std::optional<Statistics> find_between(BoxView<D, Real> left_view, BoxView<D, Real> right_view,
                                         PairSink& pairs, const PairFilters& filters) {
    const core::DefaultEnvironment environment;
    core::check_count(left_view.size() + right_view.size());
    const std::size_t right_count = right_view.size();
    find::check_filters(filters, left_view.size(), &right_count);
    std::span<const Box<D, Real>> left = find::array_of(left_view, gathered_[0]);
    std::span<const Box<D, Real>> right = find::array_of(right_view, gathered_[1]);
    const std::size_t absent = check(left, right);
    if (!touching) {
      left = find::half_open_boxes(left, gathered_[0]);
      right = find::half_open_boxes(right, gathered_[1]);
    }
    return find::deliver(environment, pairs, [&](PairSink& sink) {
      return search_.find_between(left, right, {filters, workers, nullptr, absent}, sink);
    });
  }

  std::optional<Statistics> find_across(std::span<const Box<D, Real>> boxes, std::size_t left_count,
                                        PairSink& pairs) {
    const core::DefaultEnvironment environment;
    core::check_count(boxes.size());
    if (left_count > boxes.size()) {
      throw InvalidFrame(core::message({"a left set of ", left_count, " boxes in an array of ", boxes.size(),
                                        "; expected at most ", boxes.size()}));
    }
    const std::size_t absent = check(boxes.first(left_count), boxes.subspan(left_count));
    if (!touching) boxes = find::half_open_boxes(boxes, gathered_[0]);
    return find::deliver(environment, pairs, [&](PairSink& sink) {
      return search_.find_across(boxes, left_count, {{}, workers, nullptr, absent}, sink);
    });
  }

  std::span<const BoxId> quarantined() const noexcept { return quarantined_; }
  std::string explanation() const { return search_.explanation(); }

  BadInput bad_input = BadInput::reject;
  bool touching = true;
  Workers workers;

 private:
  std::size_t check(std::span<const Box<D, Real>> boxes, bool are_present) {
    const std::size_t absent = are_present ? 0 : search_.check_and_count_absent(boxes, workers, bad_input);
    quarantined_.clear();
    if (absent > 0) list_invalid(boxes, 0);
    return absent;
  }

  std::size_t check(std::span<const Box<D, Real>> left, std::span<const Box<D, Real>> right) {
    const std::size_t absent_left = search_.check_and_count_absent(left, workers, bad_input, "left ");
    const std::size_t absent_right = search_.check_and_count_absent(right, workers, bad_input, "right ");
    quarantined_.clear();
    if (absent_left > 0) list_invalid(left, 0);
    if (absent_right > 0) list_invalid(right, left.size());
    return absent_left + absent_right;
  }

  void list_invalid(std::span<const Box<D, Real>> boxes, std::size_t first) {
    if (bad_input == BadInput::quarantine) find::list_invalid(boxes, first, quarantined_);
  }

  find::Search<D, Real> search_;
  std::array<std::vector<Box<D, Real>>, 2> gathered_;  // boxes that were not given as an array
  std::vector<BoxId> quarantined_;
};

template <int D, typename Real>
Finder<D, Real>::Finder(const Algorithm& algorithm, const Spec& spec) {
  Settings settings = algorithm::settings_of(algorithm, spec);
  const std::size_t threads = algorithm::threads_of(algorithm, settings);
  state_ = std::make_unique<State>(find::searchers_of<D>(algorithm, std::move(settings)), threads);
}

template <int D, typename Real>
Finder<D, Real>::Finder(const Spec& spec) : Finder(algorithm::require_algorithm(spec.name), spec) {}

template <int D, typename Real>
Finder<D, Real>::Finder(std::unique_ptr<Searcher<D>> searcher) {
  if (searcher == nullptr)
    throw std::invalid_argument("Finder was given a null searcher; expected a searcher");
  state_ = std::make_unique<State>(find::Searchers<D>{find::checked(std::move(searcher))}, 1);
}

template <int D, typename Real>
Finder<D, Real>::Finder(Finder&& other) noexcept = default;
template <int D, typename Real>
Finder<D, Real>& Finder<D, Real>::operator=(Finder&& other) noexcept = default;
template <int D, typename Real>
Finder<D, Real>::~Finder() = default;

template <int D, typename Real>
std::optional<Statistics> Finder<D, Real>::find(BoxView<D, Real> boxes, PairSink& pairs,
                                                const PairFilters& filters) {
  return state_->find(boxes, pairs, filters);
}

template <int D, typename Real>
std::optional<Statistics> Finder<D, Real>::find_between(BoxView<D, Real> left, BoxView<D, Real> right,
                                                        PairSink& pairs, const PairFilters& filters) {
  return state_->find_between(left, right, pairs, filters);
}

template <int D, typename Real>
std::optional<Statistics> Finder<D, Real>::find_across(std::span<const Box<D, Real>> boxes,
                                                       std::size_t left_count, PairSink& pairs) {
  return state_->find_across(boxes, left_count, pairs);
}

template <int D, typename Real>
BadInput Finder<D, Real>::bad_input() const noexcept {
  return state_->bad_input;
}

template <int D, typename Real>
void Finder<D, Real>::set_bad_input(BadInput bad_input) noexcept {
  state_->bad_input = bad_input;
}

template <int D, typename Real>
std::span<const BoxId> Finder<D, Real>::quarantined() const noexcept {
  return state_->quarantined();
}

template <int D, typename Real>
bool Finder<D, Real>::touching() const noexcept {
  return state_->touching;
}

template <int D, typename Real>
void Finder<D, Real>::set_touching(bool touching) noexcept {
  state_->touching = touching;
}

template <int D, typename Real>
const Workers& Finder<D, Real>::workers() const noexcept {
  return state_->workers;
}

template <int D, typename Real>
void Finder<D, Real>::set_workers(const Workers& workers) {
  state_->workers = workers;
}

template <int D, typename Real>
std::string Finder<D, Real>::explanation() const {
  return state_->explanation();
}

template class Finder<2, float>;
template class Finder<2, double>;
template class Finder<3, float>;
template class Finder<3, double>;

}  // namespace broadside
