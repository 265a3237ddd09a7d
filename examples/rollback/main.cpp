// Rollback, as in networked games: the game continues with a predicted input of the other player. When the
// real input arrives late, the game returns to the frame of that input and replays the frames after it.
#include <array>
#include <cstddef>
#include <cstdio>
#include <vector>

#include <broadside/broadside.hpp>

namespace {

constexpr std::size_t frames = 60;
constexpr std::size_t delay = 7;  // frames until the other player's input is known

/// The other player's real input in a frame; -1 or 1.
int truth(std::size_t frame) { return frame / 10 % 2 == 0 ? 1 : -1; }

/// Two boxes on a line, and walls to touch.
struct Game {
  broadside::World2 world;
  std::array<broadside::Handle, 2> players;

  Game() {
    for (int i = 0; i <= 10; ++i) {
      const auto wall = 4 * static_cast<float>(i);
      world.add({{wall, 0}, {wall + 0.5F, 1}}, {.filter = {.is_static = true}});
    }
    for (broadside::Handle& player : players) player = world.add({{20, 0}, {21, 1}});
    world.update();
  }

  void move(broadside::Handle player, int way) {
    world.move(player, translated(world.box(player), {0.25F * static_cast<float>(way), 0}));
  }

  /// Runs one frame; returns how many pairs began.
  std::size_t step(std::size_t frame, int others_way) {
    move(players[0], frame % 3 == 0 ? 1 : -1);
    move(players[1], others_way);
    return world.update().begun.size();
  }
};

}  // namespace

int main() {
  Game game;
  std::vector<std::vector<std::byte>> before;  // snapshot before each frame
  std::vector<int> played;                     // the other player's input as used in each frame
  std::size_t rollbacks = 0;
  for (std::size_t frame = 0; frame < frames + delay; ++frame) {
    if (frame >= delay && played[frame - delay] != truth(frame - delay)) {
      ++rollbacks;
      game.world.restore(before[frame - delay]);
      const int known = truth(frame - delay);
      for (std::size_t again = frame - delay; again < played.size(); ++again) {
        before[again] = game.world.snapshot();
        played[again] = known;  // predict that the input stays the same
        game.step(again, known);
      }
    }
    if (frame >= frames) continue;
    before.push_back(game.world.snapshot());
    played.push_back(played.empty() ? 1 : played.back());
    game.step(frame, played.back());
  }

  // Knowing all inputs from the start must lead to the same state.
  Game known;
  for (std::size_t frame = 0; frame < frames; ++frame) known.step(frame, truth(frame));
  const bool same = known.world.snapshot() == game.world.snapshot();
  std::printf("%zu frames, %zu rollbacks: %s\n", frames, rollbacks,
              same ? "the same world" : "another world");
  return same ? 0 : 1;
}
