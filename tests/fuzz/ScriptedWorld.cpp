#include "ScriptedWorld.h"

#include <algorithm>
#include <utility>

#include "shared/replica/ViewFollow.h"

namespace naiad::fuzz {
namespace {

constexpr df::Fixed kHalf = df::kFixedOne / 2;

df::FixedVector cells(int x, int y) {
  return {df::fromCells(x), df::fromCells(y)};
}

df::Fixed coordinate(Script& script, int extent) {
  const auto fine = script.number<std::uint16_t>();  // in 1/256 of a cell
  return static_cast<df::Fixed>(fine % ((extent + 8) * 256)) * (df::kFixedOne / 256) - df::fromCells(4);
}

df::Fixed signedByte(Script& script, df::Fixed unit) {
  return static_cast<std::int8_t>(script.byte()) * unit;
}

}  // namespace

ScriptedWorld::ScriptedWorld() {
  m_view.boundary = {{}, cells(kWidth, kHeight)};
  m_view.view_width = kViewWidth;
  m_view.view_height = kViewHeight;
  m_view.players.emplace_back().id = 1;
  for (std::uint32_t slot = 0; slot < kThings; ++slot) m_things[slot].facts.key.slot = slot;
}

void ScriptedWorld::happen(Script& script) {
  const std::uint8_t what = script.byte();
  Thing& thing = m_things[script.below(kThings)];
  if (!thing.alive) {
    if (what % 10 == 8) return speak(script);
    return bear(thing, script);
  }
  switch (what % 10) {
    case 0:
    case 1:
      return turn(thing, script);
    case 2:
      return place(thing, script);
    case 3:
      return restyle(thing, script);
    case 4:
      return reshape(thing, script);
    case 5:
      return kill(thing);
    case 6:
      thing.facts.shown = !thing.facts.shown;
      thing.changed = true;
      return;
    case 7:
      return follow(thing, script);
    case 8:
      return speak(script);
    default:
      m_loose.push_back({{coordinate(script, kWidth), coordinate(script, kHeight)}, U'*', df::YELLOW});
  }
}

void ScriptedWorld::bear(Thing& thing, Script& script) {
  const df::ObjectKey key{thing.facts.key.slot, thing.facts.key.generation + 1};
  thing = {};
  thing.alive = true;
  thing.facts.key = key;
  thing.facts.order = m_next_order++;
  thing.facts.box = {cells(-2, -1), cells(4, 2)};
  place(thing, script);
  turn(thing, script);
  restyle(thing, script);
}

void ScriptedWorld::kill(Thing& thing) {
  m_gone.push_back(thing.facts.key);
  thing.alive = false;
  df::PlayerFacts& player = m_view.players[0];
  if (player.followed == thing.facts.key) player.followed = {};
}

void ScriptedWorld::place(Thing& thing, Script& script) {
  thing.facts.position.x = coordinate(script, kWidth);
  thing.facts.position.y = coordinate(script, kHeight);
  thing.changed = true;
  noteMoved(thing);
}

void ScriptedWorld::turn(Thing& thing, Script& script) {
  const std::uint8_t how = script.byte();
  thing.facts.velocity = thing.facts.acceleration = {};
  if ((how & 1) != 0) thing.facts.velocity.x = signedByte(script, df::kFixedOne / 64);
  if ((how & 2) != 0) thing.facts.velocity.y = signedByte(script, df::kFixedOne / 128);
  if ((how & 4) != 0) thing.facts.velocity.x += script.byte();  // finer than any coarse grid
  if ((how & 24) == 24) thing.facts.acceleration.x = signedByte(script, df::kFixedOne / 4096);
  if ((how & 40) == 40) thing.facts.acceleration.y = signedByte(script, df::kFixedOne / 4096);
  thing.changed = true;
}

/// Gives the object a word whose frames change by a clock or an angle.
void ScriptedWorld::animate(Thing& thing, Script& script) {
  const std::uint8_t how = script.byte();
  std::vector<Appearance> frames(2 + how % 4);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (std::int32_t i = 0; i < 3; ++i)
      frames[k].push_back({256 * i - 128 * (how >> 2 & 1), 256 * static_cast<std::int32_t>(k % 2),
                           U'a' + static_cast<char32_t>(k), df::GREEN});
  }
  const std::size_t count = frames.size();
  const std::uint8_t pace = script.byte();
  Selector selector = Selector::clock(m_view.tick, 1 + pace % 8, (how & 8) != 0, pace % count);
  if ((how & 16) != 0) selector = Selector::turning(m_view.tick, how << 24, (pace - 128) * 1'000'003);
  thing.p_told = std::make_shared<const Look>(Look{Sequence(std::move(frames)), 0, selector});
}

void ScriptedWorld::restyle(Thing& thing, Script& script) {
  const std::uint8_t how = script.byte();
  const auto color = static_cast<df::Color>(how >> 5);
  const auto letter = static_cast<char32_t>(U'a' + (how >> 3) % 4);
  thing.look.clear();
  thing.p_told = nullptr;
  const auto row = [&](int count, df::Fixed left, df::Fixed top) {
    for (int i = 0; i < count; ++i) thing.look.push_back({{left + df::fromCells(i), top}, letter, color});
  };
  switch (how % 8) {
    case 0:
      return;  // a look without characters
    case 1:
      return row(1, 0, 0);
    case 2:
      return animate(thing, script);
    case 3:
      return row(6, df::fromCells(-3), df::fromCells(1));
    case 4:
      return row(4, -kHalf * 3, 0);  // a sprite of even width: its cells are at half offsets
    case 5:
      return row(2, signedByte(script, df::kFixedOne / 64 + 3), signedByte(script, df::kFixedOne / 64 + 5));
    case 6:  // a look that may be too large for a datagram
      for (int y = 0, rows = script.byte() % 64; y < rows; ++y)
        row(30, df::fromCells(-15), df::fromCells(y - 8));
      return;
    default:
      row(3, 0, 0);
      thing.look.push_back({cells(1, -1), U'é', df::WHITE});
  }
}

void ScriptedWorld::reshape(Thing& thing, Script& script) {
  const std::uint8_t how = script.byte();
  thing.facts.altitude = how % 5;
  thing.facts.solidness = static_cast<df::Solidness>(how / 5 % 3);
  thing.facts.no_soft = (how & 128) != 0;
  if ((how & 64) != 0) thing.facts.box.size = {df::fromCells(4) + script.byte(), df::fromCells(2)};
  thing.changed = true;
}

void ScriptedWorld::follow(const Thing& thing, Script& script) {
  df::PlayerFacts& player = m_view.players[0];
  player.followed = {};
  if (script.byte() % 4 == 0) return;
  player.followed = thing.facts.key;
  const ViewFrame frame{player.view_corner, cells(kViewWidth, kViewHeight), m_view.boundary};
  player.view_corner = clampView(frame, thing.facts.position - cells(kViewWidth / 2, kViewHeight / 2));
}

void ScriptedWorld::speak(Script& script) {
  std::vector<df::PlayerText>& texts = m_view.players[0].texts;
  const auto id = static_cast<std::uint32_t>(script.below(4));
  std::erase_if(texts, [id](const df::PlayerText& text) { return text.id == id; });
  const std::size_t length = script.below(40);
  if (length == 0) return;
  const df::PlayerText text{id, static_cast<int>(script.below(12)) - 2, static_cast<int>(script.below(3)),
                            df::CYAN, std::string(length, static_cast<char>('0' + id))};
  texts.insert(std::find_if(texts.begin(), texts.end(), [id](const auto& other) { return other.id > id; }),
               text);
}

void ScriptedWorld::noteMoved(const Thing& thing) {
  df::PlayerFacts& player = m_view.players[0];
  if (player.followed != thing.facts.key) return;
  const ViewFrame frame{player.view_corner, cells(kViewWidth, kViewHeight), m_view.boundary};
  player.view_corner = followView(frame, thing.facts.position);
}

void ScriptedWorld::tick() {
  ++m_view.tick;
  m_view.vanished = std::exchange(m_gone, {});
  m_view.changed.clear();
  m_view.drawn.clear();
  m_view.commands.clear();
  m_view.looks.clear();
  std::vector<Thing*> alive;
  for (Thing& thing : m_things) {
    if (!thing.alive) continue;
    alive.push_back(&thing);
    df::ObjectFacts& facts = thing.facts;
    if (facts.velocity != df::FixedVector{} || facts.acceleration != df::FixedVector{}) {
      facts.position = facts.position + facts.velocity;
      facts.velocity = facts.velocity + facts.acceleration;
      thing.changed = true;
      noteMoved(thing);
    }
  }
  std::sort(alive.begin(), alive.end(),
            [](const Thing* a, const Thing* b) { return a->facts.order < b->facts.order; });
  for (Thing* thing : alive) {
    if (std::exchange(thing->changed, false)) m_view.changed.push_back(thing->facts);
  }
  std::stable_sort(alive.begin(), alive.end(),
                   [](const Thing* a, const Thing* b) { return a->facts.altitude < b->facts.altitude; });
  const auto draw = [this](df::ObjectKey key, df::FixedVector at, const std::vector<df::DrawCommand>& look) {
    m_view.drawn.push_back(
        {key, static_cast<std::uint32_t>(m_view.commands.size()), static_cast<std::uint32_t>(look.size())});
    for (const df::DrawCommand& command : look)
      m_view.commands.push_back({at + command.position, command.ch, command.color});
  };
  if (!m_loose.empty()) draw({}, {}, m_loose);
  for (const Thing* thing : alive) {
    if (!thing->facts.shown) continue;
    if (thing->p_told == nullptr) {
      draw(thing->facts.key, thing->facts.position, thing->look);
      continue;
    }
    std::vector<df::DrawCommand> frame;
    for (const Glyph& glyph : *thing->p_told->select(m_view.tick)) {
      frame.push_back(
          {{df::Fixed{glyph.dx} * (df::kFixedOne / 256), df::Fixed{glyph.dy} * (df::kFixedOne / 256)},
           glyph.ch,
           glyph.color});
    }
    m_view.looks.push_back({static_cast<std::uint32_t>(m_view.drawn.size()), thing->p_told});
    draw(thing->facts.key, thing->facts.position, frame);
  }
  m_loose.clear();
}

df::Canvas ScriptedWorld::picture() const {
  const df::PlayerFacts& player = m_view.players[0];
  df::Canvas canvas(kViewWidth, kViewHeight);
  for (const df::DrawCommand& command : m_view.commands) {
    canvas.put(df::cellOf(command.position.x) - df::cellOf(player.view_corner.x),
               df::cellOf(command.position.y) - df::cellOf(player.view_corner.y),
               {command.ch, command.color});
  }
  for (const df::PlayerText& text : player.texts) {
    int x = text.x;
    for (const char32_t ch : df::decodeUtf8(text.text)) canvas.put(x++, text.y, {ch, text.color});
  }
  return canvas;
}

}  // namespace naiad::fuzz
