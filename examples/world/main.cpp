// A World in a small engine: a static level, falling bodies, a cart with its trailer on a joint, and a
// trigger that only players activate.
#include <cstdio>
#include <string>
#include <vector>

#include <broadside/broadside.hpp>

namespace {

using broadside::Box2;
using broadside::Handle;

enum Category : unsigned { level = 1, body = 2, player = 4, trigger = 8 };

/// The game's record of a box; the box's user data is its index in the list of records.
struct Entity {
  std::string name;
  Handle handle;
  float fall = 0;  ///< per frame
};

Box2 square(float x, float y) { return {{x, y}, {x + 1, y + 1}}; }

class Game {
 public:
  Game() {
    const broadside::Filter of_level{.category = level, .is_static = true};
    spawn("floor", {{-50, -1}, {50, 0}}, of_level);
    spawn("wall", {{49, 0}, {50, 20}},
          of_level);  // it touches the ground, but their filters exclude the pair
    spawn("door", {{4, 0}, {6, 3}}, {.category = trigger, .mask = player});
    spawn("crate", square(5, 2), {.category = body}, 1);
    spawn("player", square(8, 0), {.category = player});
    const Handle cart = spawn("cart", square(20, 5), {.category = body}, 1);
    const Handle trailer = spawn("trailer", square(21, 5), {.category = body}, 1);
    world_.ignore(cart, trailer);  // they are connected by a joint
  }

  void step() {
    for (Entity& entity : entities_) {
      if (!world_.contains(entity.handle)) continue;
      if (entity.fall != 0) shift(entity, 0, -entity.fall);
      if (entity.name == "player") shift(entity, -1, 0);
    }
    const broadside::Events events = world_.update();
    for (const broadside::HandlePair pair : events.ended) tell(pair, "leaves");
    for (const broadside::HandlePair pair : events.begun) {
      tell(pair, "meets");
      for (const Handle handle : {pair.first, pair.second}) entity_of(handle).fall = 0;
    }
    ++frame_;
  }

  void destroy(const std::string& name) {
    for (const Entity& entity : entities_) {
      if (entity.name == name) world_.remove(entity.handle);
    }
  }

 private:
  Handle spawn(const std::string& name, const Box2& box, const broadside::Filter& filter, float fall = 0) {
    const Handle handle = world_.add(box, {.filter = filter, .user_data = entities_.size()});
    entities_.push_back({name, handle, fall});
    return handle;
  }

  void shift(const Entity& entity, float x, float y) {
    world_.move(entity.handle, translated(world_.box(entity.handle), {x, y}));
  }

  /// Also valid for a removed box while its last pairs end.
  Entity& entity_of(Handle handle) { return entities_[world_.user_data(handle)]; }

  void tell(const broadside::HandlePair& pair, const char* what) {
    std::printf("%d: %s %s %s\n", frame_, entity_of(pair.first).name.c_str(), what,
                entity_of(pair.second).name.c_str());
  }

  broadside::World2 world_;
  std::vector<Entity> entities_;
  int frame_ = 0;
};

}  // namespace

int main() {
  Game game;
  for (int i = 0; i < 8; ++i) {
    if (i == 6) game.destroy("crate");
    game.step();
  }
}
