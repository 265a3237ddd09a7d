// Histories of worlds: whatever is done to a world's handles is done to its model as well, and the two must
// agree. What is done comes from a source of choices.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "tests/support/drawn_boxes.hpp"
#include "tests/support/rng.hpp"
#include "tests/support/world_model.hpp"

namespace broadside {

/// A world is not what its model is.
struct WorldDivergence final : std::logic_error {
  using std::logic_error::logic_error;
};

/// What a history of a world is made of.
template <int D, typename Real = float>
struct WorldCourse {
  WorldOptions options{};
  std::function<Box<D, Real>(Choices&)> box{};
  bool has_filters = true;
  bool has_predicate = false;
  bool predicate_throws = false;           ///< now and then
  bool shifts = false;                     ///< the origin, where that rounds nothing
  bool trusts_enlarged = false;            ///< the world's enlarged boxes, which need only contain the boxes
  std::size_t max_some = 3;                ///< boxes that one call changes
  bool tells = false;                      ///< a divergence with all that was done before it
  std::function<World<D, Real>()> make{};  ///< a world; by default one of these options
  /// Runs a call of the world, and returns whether it came to its end. By default every one does.
  std::function<bool(const std::function<void()>& call)> attempt{};
};

template <int D, typename Real = float>
class WorldHistory {
 public:
  using Model = WorldModel<D, Real>;
  using Course = WorldCourse<D, Real>;
  using Bytes = std::vector<std::byte>;

  WorldHistory(Choices& choices, Course course) : choices_(&choices), course_(std::move(course)) {
    while (!attempt([&] { world_.emplace(made()); })) {
    }
    model_.options = course_.options;
    set_model_predicate();
  }

  /// Another world that goes on from here by its own choices.
  WorldHistory twin(Choices& choices) const {
    WorldHistory twin(choices, course_);
    *twin.predicate_ = *predicate_;
    const Bytes bytes = world_->snapshot();
    twin.world_->restore(bytes);
    twin.expect(twin.world_->snapshot() == bytes, "a snapshot of what was restored is another one");
    twin.adopt(model_);
    return twin;
  }

  World<D, Real>& world() { return *world_; }
  Model& model() { return model_; }

  /// Takes what the world has been made by other means to be.
  void adopt(const Model& model) {
    model_ = model;
    course_.options = model.options;
    set_model_predicate();
  }

  /// Changes the world in one way.
  void change() {
    const std::size_t what = choices_->below(24);
    if (what < 6 || model_.members.size() < 2) return add();
    if (what < 11) return move();
    if (what == 11) return move_onto_another();
    if (what == 12) return move_with_velocity();
    if (what < 16) return remove();
    if (what == 16) return misuse();
    if (what == 17) return shrink_or_shift();
    if (!course_.has_filters) return;
    if (what < 20) return set_filter();
    if (what < 23) return toggle_ignored();
    change_predicate();
  }

  void add(std::size_t count) {
    std::vector<Box<D, Real>> boxes(count);
    for (Box<D, Real>& box : boxes) box = course_.box(*choices_);
    std::vector<BoxOptions> options(count);
    const bool has_options = choices_->one_in(2);
    for (BoxOptions& its : options) {
      if (has_options && course_.has_filters) its.filter = any_filter(*choices_);
      if (has_options) its.user_data = choices_->below(3);
    }
    std::vector<Handle> handles(count);
    const bool is_one = count == 1 && choices_->one_in(2);
    const std::span<const BoxOptions> given = std::span(options).first(has_options ? count : 0);
    if (!attempt([&] {
          if (is_one)
            handles[0] = world_->add(boxes[0], options[0]);
          else
            world_->add(boxes, handles, given);
        }))
      return;
    for (std::size_t i = 0; i < count; ++i) {
      note("add", handles[i], boxes[i]);
      expect(!model_.members.contains(handles[i]) && !model_.removed.contains(handles[i]),
             "a new box has another one's handle");
      model_.add(handles[i], boxes[i], options[i]);
    }
  }

  void remove(const std::vector<Handle>& handles) {
    const bool is_one = handles.size() == 1 && choices_->one_in(2);
    if (!attempt([&] { is_one ? world_->remove(handles[0]) : world_->remove(handles); })) return;
    for (const Handle handle : handles) {
      note("remove", handle, model_.members.at(handle).box);
      model_.remove(handle);
    }
  }

  void move(const std::vector<Handle>& handles, const std::vector<Box<D, Real>>& boxes) {
    const bool is_one = handles.size() == 1 && choices_->one_in(2);
    if (!attempt([&] { is_one ? world_->move(handles[0], boxes[0]) : world_->move(handles, boxes); })) return;
    for (std::size_t i = 0; i < handles.size(); ++i) {
      note("move", handles[i], boxes[i]);
      model_.move(handles[i], boxes[i]);
    }
  }

  /// Updates, and compares what the world tells. False if the update failed: its events wait for the next.
  bool update() {
    note("update");
    predicate_->throws = course_.predicate_throws && choices_->one_in(8);
    Events events;
    const auto call = [&] { return attempt([&] { events = world_->update(); }); };
    is_failed_ = true;
    try {
      if (!call()) return false;
    } catch (const PredicateFails&) {
      predicate_->throws = false;
      if (choices_->one_in(2) || !call()) return false;
    }
    predicate_->throws = false;
    is_failed_ = false;
    trust_enlarged();
    model_.update();
    expect_equal("begun", events.begun, model_.begun);
    expect_equal("ended", events.ended, model_.ended);
    expect(world_->statistics().pairs == model_.pairs.size(), "the count of pairs is wrong");
    // Not always, so that events of several updates wait to be taken in.
    if (!choices_->one_in(3)) look_at_pairs();
    return true;
  }

  /// Asks for what can be asked at any time.
  void look() {
    const Box<D, Real> place = course_.box(*choices_);
    const Box<D, Real> kept = model_.options.touching ? place : half_open(place);
    if (attempt([&] { static_cast<void>(world_->box_index()); })) {
      std::vector<Handle> found;
      std::vector<Handle> expected;
      world_->overlapping(place, [&found](Handle handle) { found.push_back(handle); });
      for (const auto& [handle, its] : model_.members) {
        if (is_present(its.box) && overlap(its.box, kept)) expected.push_back(handle);
      }
      std::ranges::sort(found);
      expect(found == expected, "a query finds other boxes");
    }
    if (course_.options.keep_pairs) {
      if (attempt([&] { static_cast<void>(world_->pairs()); }))
        expect_equal("the pairs", world_->pairs(), model_.pairs);
      if (attempt([&] { static_cast<void>(world_->persisting()); }))
        expect_equal("persisting", world_->persisting(), model_.persisting);
    }
    Bytes bytes;
    if (attempt([&] { bytes = world_->snapshot(); }))
      expect(bytes == world_->snapshot(), "a snapshot differs from the next");
  }

  /// Keeps what there is, or goes back to what was kept: in this world, a new one, or one that came after it.
  void go_back() {
    if (!kept_ || kept_->phase != predicate_->phase || choices_->one_in(2)) {
      kept_ = Kept{world_->snapshot(), model_, predicate_->phase, is_failed_};
      return note("keep");
    }
    note("go back");
    const std::size_t how = course_.attempt ? 0 : choices_->below(3);
    if (how == 1) world_ = made();
    if (how == 2) {
      World<D, Real> other = made();
      other.restore(world_->snapshot());
      other.update();
      world_ = std::move(other);
    }
    world_->restore(kept_->bytes);
    expect(world_->snapshot() == kept_->bytes, "a snapshot of what was restored is another one");
    is_failed_ = kept_->is_failed;
    adopt(kept_->model);
  }

  /// Compares everything that the world says of its boxes.
  void check() {
    trust_enlarged();
    expect(world_->size() == model_.members.size(), "the number of boxes is wrong");
    for (const auto& [handle, its] : model_.members) {
      expect(world_->contains(handle) && world_->box(handle) == its.box, "a box is not what it was set to");
      expect(world_->filter(handle) == its.filter, "a filter is not what it was set to");
      expect(world_->user_data(handle) == its.user_data, "user data is not what it was set to");
      if (is_present(its.box))
        expect(world_->enlarged_box(handle) == its.enlarged, "an enlarged box is wrong");
    }
    for (const auto& [handle, removal] : model_.removed) {
      expect(!world_->contains(handle), "a removed box is there");
      // Readable until the update after the one that reported the removal.
      if (removal.updates < 2)
        expect(world_->box(handle) == removal.box, "a removed box is not what it was");
      else if (removal.updates == 2)
        expect_throw<InvalidHandle>([&, &its = handle] { static_cast<void>(world_->box(its)); });
    }
    expect(world_->statistics().ignored_pairs == model_.ignored.size(),
           "the count of ignored pairs is wrong");
  }

  void expect(bool holds, const std::string& what) const {
    if (!holds) throw WorldDivergence(what + "; " + world_->statistics().explanation + told_);
  }

 private:
  struct PredicateFails final : std::runtime_error {
    PredicateFails() : std::runtime_error("the predicate fails") {}
  };

  /// What the predicate answers.
  struct Predicate {
    std::uint32_t phase = 0;
    bool throws = false;

    bool operator()(Handle a, Handle b) const {
      if (throws) throw PredicateFails();
      return (a.slot + b.slot + a.generation) % 3 != phase;
    }
  };

  struct Kept {
    Bytes bytes;
    Model model;
    std::uint32_t phase;
    bool is_failed;
  };

  bool attempt(const std::function<void()>& call) {
    if (course_.attempt) return course_.attempt(call);
    call();
    return true;
  }

  static auto asking(std::shared_ptr<Predicate> predicate) {
    return [predicate = std::move(predicate)](Handle a, Handle b) { return (*predicate)(a, b); };
  }

  World<D, Real> made() const {
    World<D, Real> world = course_.make ? course_.make() : World<D, Real>(course_.options);
    if (course_.has_predicate) world.set_predicate(asking(predicate_));
    return world;
  }

  void set_model_predicate() {
    if (course_.has_predicate) model_.predicate = asking(predicate_);
  }

  Handle any() {
    return std::next(model_.members.begin(), std::ptrdiff_t(choices_->below(model_.members.size())))->first;
  }

  std::size_t some(std::size_t most) {
    return choices_->one_in(3) ? choices_->below(std::min(most, course_.max_some) + 1) : 1;
  }

  std::vector<Handle> some_handles() {
    std::set<Handle> handles;
    for (std::size_t i = some(model_.members.size()); i > 0; --i) handles.insert(any());
    return {handles.begin(), handles.end()};
  }

  void add() { add(some(course_.max_some)); }

  void move() {
    const std::vector<Handle> handles = some_handles();
    std::vector<Box<D, Real>> boxes(handles.size());
    for (Box<D, Real>& box : boxes) box = course_.box(*choices_);
    move(handles, boxes);
  }

  /// One call that moves a box to where another one is, which goes elsewhere: it may be the same one.
  void move_onto_another() {
    const std::vector<Handle> handles = {any(), any()};
    const Box<D, Real> onto = model_.members.at(handles[1]).box;
    if (is_present(onto)) move(handles, {onto, course_.box(*choices_)});
  }

  void move_with_velocity() {
    const Handle handle = any();
    const Box<D, Real> box = course_.box(*choices_);
    Point<D, Real> velocity;
    for (int axis = 0; axis < D; ++axis) velocity[axis] = static_cast<Real>(choices_->whole(-1, 2)) / 2;
    if (course_.options.predicted_frames == 0)
      return expect_throw<std::logic_error>([&] { world_->move(handle, box, velocity); });
    const bool is_one = choices_->one_in(2);
    if (!attempt([&] {
          if (is_one)
            world_->move(handle, box, velocity);
          else
            world_->move(std::vector{handle}, std::vector{box}, std::vector{velocity});
        }))
      return;
    note("move with a velocity", handle, box);
    model_.move(handle, box, velocity);
  }

  void remove() { remove(some_handles()); }

  /// Uses a removed box, or a box that is none, which is refused or put in quarantine.
  void misuse() {
    if (!model_.removed.empty() && choices_->one_in(2)) {
      const std::size_t place = choices_->below(model_.removed.size());
      const Handle handle = std::next(model_.removed.begin(), std::ptrdiff_t(place))->first;
      expect_throw<InvalidHandle>([&] { world_->move(handle, Box<D, Real>{}); });
      expect_throw<InvalidHandle>([&] { world_->remove(handle); });
      expect_throw<InvalidHandle>([&] { world_->set_filter(handle, {}); });
      return;
    }
    const Handle handle = any();
    Box<D, Real> wrong{};
    wrong.max[0] = std::numeric_limits<Real>::quiet_NaN();
    if (course_.options.bad_input != BadInput::quarantine)
      return expect_throw<InvalidInput>([&] { world_->move(handle, wrong); });
    if (!attempt([&] { world_->move(handle, wrong); })) return;
    note("move to a NaN", handle, wrong);
    model_.move(handle, absent_box<D, Real>());
  }

  void shrink_or_shift() {
    if (!course_.shifts || choices_->one_in(2)) {
      attempt([&] { world_->shrink_to_fit(); });
      return note("shrink");
    }
    Point<D, Real> origin;
    origin.fill(static_cast<Real>(0.25));
    if (!attempt([&] { world_->shift_origin(origin); })) return;
    note("shift");
    model_.shift_origin(origin);
  }

  void set_filter() {
    const Handle handle = any();
    const Filter filter = any_filter(*choices_);
    if (!attempt([&] { world_->set_filter(handle, filter); })) return;
    note("filter", handle, model_.members.at(handle).box);
    model_.members.at(handle).filter = filter;
  }

  /// Mostly of boxes that overlap, since an ignored pair is to matter.
  void toggle_ignored() {
    const Handle a = any();
    Handle b = any();
    if (!choices_->one_in(3)) {
      for (const auto& [handle, its] : model_.members) {
        if (handle != a && overlap(its.box, model_.members.at(a).box)) b = handle;
      }
    }
    if (a == b) return;
    const HandlePair pair = Model::ordered(a, b);
    // Now and then what is so already.
    const bool ignores = model_.ignored.contains(pair) == choices_->one_in(8);
    if (attempt([&] { ignores ? world_->ignore(a, b) : world_->unignore(a, b); })) {
      note(ignores ? "ignore" : "unignore", a, model_.members.at(a).box);
      if (ignores)
        model_.ignored.insert(pair);
      else
        model_.ignored.erase(pair);
    }
    expect(world_->is_ignored(b, a) == model_.ignored.contains(pair), "a pair is ignored wrongly");
  }

  void change_predicate() {
    const auto phase = static_cast<std::uint32_t>(choices_->below(4));
    // A failed update has asked about some pairs. Only then a new predicate is sure to be asked about all.
    if (course_.has_predicate && (course_.attempt || is_failed_)) {
      const auto other = std::make_shared<Predicate>(Predicate{phase});
      if (!attempt([&] { world_->set_predicate(asking(other)); })) return;
      note("set a predicate");
      predicate_ = other;
      set_model_predicate();
      return model_.refilter();
    }
    const bool is_one = choices_->one_in(2);
    const Handle handle = any();
    // An update that fails has seen pairs part, about which the next one asks again.
    if (!course_.attempt && !(is_one && course_.predicate_throws)) predicate_->phase = phase;
    if (!attempt([&] { is_one ? world_->refilter(handle) : world_->refilter(); })) return;
    note(is_one ? "refilter" : "refilter all", handle, model_.members.at(handle).box);
    is_one ? model_.refilter(handle) : model_.refilter();
  }

  void look_at_pairs() {
    if (!course_.options.keep_pairs) return;
    expect_equal("persisting", world_->persisting(), model_.persisting);
    expect_equal("the pairs", world_->pairs(), model_.pairs);
    std::vector<std::uint8_t> flags(model_.pairs.size());
    world_->overlaps(model_.pairs, flags);
    for (std::size_t i = 0; i < flags.size(); ++i) {
      const HandlePair& pair = model_.pairs[i];
      expect(
          (flags[i] == 1) == overlap(model_.members.at(pair.first).box, model_.members.at(pair.second).box),
          "overlaps() is wrong");
    }
  }

  void trust_enlarged() {
    if (!course_.trusts_enlarged) return;
    for (auto& [handle, its] : model_.members) {
      its.enlarged = world_->enlarged_box(handle);
      expect(!is_present(its.box) || contains(its.enlarged, its.box), "a box is not in its enlarged one");
    }
  }

  template <typename Error, typename Call>
  void expect_throw(Call call) const {
    try {
      call();
    } catch (const Error&) {
      return;
    }
    expect(false, "what must be refused was not");
  }

  void expect_equal(const char* what, std::span<const HandlePair> found,
                    const std::vector<HandlePair>& expected) const {
    expect(std::ranges::equal(found, expected), std::string(what) + ": " + std::to_string(found.size()) +
                                                    " pairs are not the " + std::to_string(expected.size()) +
                                                    " expected");
  }

  void note(const char* what) {
    if (course_.tells) told_ += std::string("\n  ") + what;
  }

  void note(const char* what, Handle handle, const Box<D, Real>& box) {
    if (!course_.tells) return;
    std::ostringstream text;
    text.precision(std::numeric_limits<Real>::max_digits10);
    text << "\n  " << what << " " << handle.slot << "." << handle.generation;
    for (int axis = 0; axis < D; ++axis) text << " [" << box.min[axis] << ", " << box.max[axis] << "]";
    told_ += text.str();
  }

  Choices* choices_;
  Course course_;
  std::shared_ptr<Predicate> predicate_ = std::make_shared<Predicate>();
  std::optional<World<D, Real>> world_{};
  Model model_{};
  std::optional<Kept> kept_{};
  std::string told_{};
  bool is_failed_ = false;  // since the last whole update
};

}  // namespace broadside
