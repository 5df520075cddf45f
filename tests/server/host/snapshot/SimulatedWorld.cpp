#include "SimulatedWorld.h"

#include <algorithm>

#include "shared/replica/ViewFollow.h"
#include "shared/values/Vector.h"
#include "tests/support/CellsAt.h"

namespace naiad::test {

SimulatedWorld::SimulatedWorld(const WorldConfig& config, std::uint64_t seed)
    : m_config(config), m_rng(seed) {
  m_view.boundary = {{0, 0}, cellsAt(config.width, config.height)};
  m_view.view_width = config.view_width;
  m_view.view_height = config.view_height;
  for (std::uint32_t id = 1; id <= config.players; ++id) {
    df::PlayerFacts player;
    player.id = id;
    player.name = "player " + std::to_string(id);
    m_view.players.push_back(player);
  }
}

void SimulatedWorld::tick(bool quiet) {
  ++m_view.tick;
  m_view.changed.clear();
  m_view.vanished.clear();
  m_view.drawn.clear();
  m_view.commands.clear();
  m_view.looks.clear();

  std::vector<bool> changed(m_things.size() + m_config.objects + 1, false);
  if (!quiet) {
    for (std::uint32_t slot = 0; slot < m_things.size(); ++slot) {
      if (m_things[slot].alive && chance(m_config.vanish)) kill(slot);
    }
    while (m_order.size() < m_config.objects && (m_view.tick == 1 || chance(0.7))) {
      bear();
      changed.resize(std::max(changed.size(), m_things.size()));
      changed[m_order.back()] = true;
    }
    for (const std::uint32_t slot : m_order) changed[slot] = meddle(m_things[slot]) || changed[slot];
    for (df::PlayerFacts& player : m_view.players) {
      if (m_view.tick == 1 || chance(m_config.refollow)) follow(player);
    }
    if (chance(m_config.scribble)) scribble();
    if (chance(m_config.speech)) speak();
  }
  for (const std::uint32_t slot : m_order) changed[slot] = move(m_things[slot], quiet) || changed[slot];
  draw();
  for (const std::uint32_t slot : m_order) {
    if (changed[slot]) m_view.changed.push_back(m_things[slot].facts);
  }
}

void SimulatedWorld::bear() {
  std::uint32_t slot = 0;
  if (m_free.size() > 2) {
    slot = m_free.front();
    m_free.pop_front();
  } else {
    slot = static_cast<std::uint32_t>(m_things.size());
    m_things.emplace_back().facts.key.slot = slot;
  }
  Thing& thing = m_things[slot];
  const std::uint32_t generation = thing.facts.key.generation + 1;
  thing = {};
  thing.alive = true;
  thing.facts.key = {slot, generation};
  thing.facts.order = m_next_order++;
  thing.facts.position = cellsAt(between(-5, m_config.width + 5), between(-5, m_config.height + 5));
  thing.facts.box = {cellsAt(-8, -1), cellsAt(16, 2)};  // contains every look
  turn(thing);
  restyle(thing);
  m_order.push_back(slot);
}

void SimulatedWorld::kill(std::uint32_t slot) {
  m_things[slot].alive = false;
  m_view.vanished.push_back(m_things[slot].facts.key);
  m_free.push_back(slot);
  std::erase(m_order, slot);
  for (df::PlayerFacts& player : m_view.players) {
    if (player.followed == m_things[slot].facts.key) player.followed = {};
  }
}

void SimulatedWorld::follow(df::PlayerFacts& player) {
  player.followed = {};
  if (m_order.empty() || chance(0.2)) return;
  const Thing& thing = m_things[m_order[m_rng.below(m_order.size())]];
  player.followed = thing.facts.key;
  const ViewFrame frame{player.view_corner, cellsAt(m_config.view_width, m_config.view_height),
                        m_view.boundary};
  player.view_corner =
      clampView(frame, thing.facts.position - cellsAt(m_config.view_width / 2.0, m_config.view_height / 2.0));
}

void SimulatedWorld::turn(Thing& thing) {
  thing.velocity = {};
  thing.acceleration = {};
  const double kind = m_rng.unit();
  if (kind < 0.3) return;
  thing.velocity = cellsAt(between(-1, 1), between(-0.5, 0.5));
  if (kind < 0.5) thing.velocity = cellsAt(chance(0.5) ? 1 : -1, 0);
  if (kind > 0.9) thing.acceleration = cellsAt(between(-0.05, 0.05), between(-0.02, 0.02));
}

void SimulatedWorld::restyle(Thing& thing) {
  thing.look.clear();
  thing.p_told = nullptr;
  if (m_config.animate > 0 && chance(m_config.animate)) return animate(thing);
  const auto color = static_cast<df::Color>(m_rng.below(8));
  const auto letter = static_cast<char32_t>(U'a' + m_rng.below(26));
  const double kind = m_rng.unit();
  if (kind < 0.5) {
    thing.look.push_back({{}, letter, color});
  } else if (kind < 0.7) {  // a sprite of even width, with cells at half offsets
    for (int i = 0; i < 4; ++i) thing.look.push_back({cellsAt(i - 1.5, 0), letter, color});
  } else if (kind < 0.8) {  // a string with a blank
    for (int i = 0; i < 6; ++i) thing.look.push_back({cellsAt(i - 3, 1), i == 3 ? U' ' : U'A' + i, color});
  } else if (kind < 0.9) {  // offsets that are not multiples of 1/256
    thing.look.push_back({cellsAt(between(-1, 1), between(-1, 1)), letter, color});
  }  // else: draws nothing
}

// Gives the thing a look of several frames in two colours, at whole or half cells.
void SimulatedWorld::animate(Thing& thing) {
  std::vector<Appearance> frames(2 + m_rng.below(7));
  const auto color = static_cast<df::Color>(m_rng.below(8));
  const std::int32_t half = chance(0.5) ? 128 : 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (std::int32_t i = -1; i <= 1; ++i)
      frames[k].push_back({256 * i * static_cast<std::int32_t>(k % 3) + half, 256 * i,
                           U'A' + static_cast<char32_t>(k), color});
    if (chance(0.1)) frames[k].clear();
  }
  const std::size_t count = frames.size();
  thing.p_told = std::make_shared<const Look>(Look{Sequence(std::move(frames)), 0, pace(count)});
}

Selector SimulatedWorld::pace(std::size_t frames) {
  const double kind = m_rng.unit();
  if (kind < 0.1) return Selector::fixed(m_rng.below(frames));
  const auto ticks = static_cast<std::uint32_t>(1 + m_rng.below(9));
  if (kind < 0.5) return Selector::clock(m_view.tick, ticks, kind < 0.3, m_rng.below(frames));
  return Selector::turning(m_view.tick, static_cast<std::uint32_t>(m_rng.next()),
                           static_cast<std::int32_t>(m_rng.next()) >> 5);
}

// Changes one object at random, as game code would. Returns whether its facts changed.
bool SimulatedWorld::meddle(Thing& thing) {
  const df::ObjectFacts before = thing.facts;
  if (chance(m_config.turn)) turn(thing);
  if (chance(m_config.restyle)) restyle(thing);
  if (thing.p_told != nullptr && chance(m_config.restyle)) {
    const Sequence frames = thing.p_told->sequence;
    thing.p_told = std::make_shared<const Look>(Look{frames, 0, pace(frames.size())});
  }
  if (chance(m_config.hide)) thing.facts.shown = !thing.facts.shown;
  if (chance(m_config.reshape)) {
    thing.facts.altitude = static_cast<int>(m_rng.below(5));
    thing.facts.solidness = static_cast<df::Solidness>(m_rng.below(3));
    thing.facts.no_soft = chance(0.5);
    thing.facts.box.size = cellsAt(16 + between(0, 2), 2);
  }
  if (chance(m_config.turn / 10))
    thing.facts.position = cellsAt(between(0, m_config.width), between(0, m_config.height));
  const df::ObjectFacts& after = thing.facts;
  return before.position != after.position || before.shown != after.shown ||
         before.altitude != after.altitude || before.solidness != after.solidness ||
         before.no_soft != after.no_soft || before.box != after.box;
}

// Makes one move; returns whether the facts changed. A blocked object stays, and its facts report no motion.
// It may move again in any later tick.
bool SimulatedWorld::move(Thing& thing, bool quiet) {
  df::ObjectFacts& facts = thing.facts;
  const df::FixedVector velocity_before = facts.velocity;
  const df::FixedVector acceleration_before = facts.acceleration;
  const bool wants = thing.velocity != df::FixedVector{} || thing.acceleration != df::FixedVector{};
  if (!wants || (!quiet && chance(m_config.block))) {
    facts.velocity = {};
    facts.acceleration = {};
    return velocity_before != facts.velocity || acceleration_before != facts.acceleration;
  }
  facts.position = facts.position + thing.velocity;
  thing.velocity = thing.velocity + thing.acceleration;
  facts.velocity = thing.velocity;
  facts.acceleration = thing.acceleration;
  for (df::PlayerFacts& player : m_view.players) {
    if (player.followed != facts.key) continue;
    const ViewFrame frame{player.view_corner, cellsAt(m_config.view_width, m_config.view_height),
                          m_view.boundary};
    player.view_corner = followView(frame, facts.position);
  }
  return true;
}

void SimulatedWorld::scribble() {
  m_view.drawn.push_back({{}, static_cast<std::uint32_t>(m_view.commands.size()), 0});
  for (auto n = 1 + m_rng.below(5); n > 0; --n) {
    m_view.commands.push_back(
        {cellsAt(between(0, m_config.width), between(0, m_config.height)), U'*', df::YELLOW});
    ++m_view.drawn.back().count;
  }
}

void SimulatedWorld::speak() {
  if (m_view.players.empty()) return;
  df::PlayerFacts& player = m_view.players[m_rng.below(m_view.players.size())];
  const auto id = static_cast<std::uint32_t>(m_rng.below(3));
  std::erase_if(player.texts, [id](const df::PlayerText& text) { return text.id == id; });
  if (chance(0.3)) return;
  const df::PlayerText text{id, static_cast<int>(m_rng.below(10)), static_cast<int>(m_rng.below(3)),
                            df::WHITE, "Score " + std::to_string(m_rng.below(1000)) + " é"};
  const auto after =
      std::ranges::find_if(player.texts, [id](const df::PlayerText& other) { return other.id > id; });
  player.texts.insert(after, text);
}

void SimulatedWorld::draw() {
  for (int altitude = 0; altitude <= 4; ++altitude) {
    for (const std::uint32_t slot : m_order) {
      const Thing& thing = m_things[slot];
      if (!thing.facts.shown || thing.facts.altitude != altitude) continue;
      const df::FixedBox box = df::translate(thing.facts.box, thing.facts.position);
      const bool in_view = std::ranges::any_of(m_view.players, [&](const df::PlayerFacts& player) {
        const df::FixedVector corner{df::fromCells(df::cellOf(player.view_corner.x)),
                                     df::fromCells(df::cellOf(player.view_corner.y))};
        return df::intersects(box, {corner, cellsAt(m_config.view_width, m_config.view_height)});
      });
      if (!in_view) continue;
      std::vector<df::DrawCommand> look = thing.look;
      if (thing.p_told != nullptr) {
        m_view.looks.push_back({static_cast<std::uint32_t>(m_view.drawn.size()), thing.p_told});
        for (const Glyph& glyph : *thing.p_told->select(m_view.tick))
          look.push_back({{df::Fixed{glyph.dx} << 24, df::Fixed{glyph.dy} << 24}, glyph.ch, glyph.color});
      }
      m_view.drawn.push_back({thing.facts.key, static_cast<std::uint32_t>(m_view.commands.size()),
                              static_cast<std::uint32_t>(look.size())});
      for (const df::DrawCommand& command : look)
        m_view.commands.push_back({thing.facts.position + command.position, command.ch, command.color});
    }
  }
}

df::Canvas SimulatedWorld::picture(std::size_t player) const {
  const df::PlayerFacts& facts = m_view.players[player];
  df::Canvas canvas(m_config.view_width, m_config.view_height);
  for (const df::DrawCommand& command : m_view.commands) {
    canvas.put(df::cellOf(command.position.x) - df::cellOf(facts.view_corner.x),
               df::cellOf(command.position.y) - df::cellOf(facts.view_corner.y), {command.ch, command.color});
  }
  for (const df::PlayerText& text : facts.texts) {
    int x = text.x;
    for (const char32_t ch : df::decodeUtf8(text.text)) canvas.put(x++, text.y, {ch, text.color});
  }
  return canvas;
}

std::string explain(const df::Canvas& wanted, const df::Canvas& seen) {
  std::string text;
  for (int y = 0; y < wanted.height(); ++y) {
    bool same = true;
    for (int x = 0; x < wanted.width(); ++x) same = same && wanted.at(x, y) == seen.at(x, y);
    if (!same)
      text += "row " + std::to_string(y) + "\n  " + wanted.rowText(y) + "|\n  " + seen.rowText(y) + "|\n";
  }
  return text;
}

}  // namespace naiad::test
