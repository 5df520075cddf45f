#include "host/world/ViewCodec.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "engine/world/Object.h"
#include "engine/world/WorldExtras.h"
#include "shared/net/base/Limits.h"
#include "shared/replica/Bits.h"
#include "shared/replica/ControlCodec.h"
#include "shared/replica/Limits.h"
#include "shared/replica/LookCodec.h"
#include "shared/values/FixedRange.h"

namespace naiad {

namespace {

constexpr df::Fixed cells(std::int64_t count) {
  return count << df::kFixedBits;
}

/// Limit of coordinates, larger than those of legal positions and of characters drawn near them.
constexpr df::Fixed kMaxPosition = cells(2'010'000'000);
/// Limit of a view's corner, so that the difference of two corners does not overflow.
constexpr df::Fixed kMaxCorner = cells(1'000'000'000);
constexpr std::int64_t kMaxOrder = (std::int64_t{1} << 48) - 1;
constexpr std::int64_t kLastCharacter = 0x10FFFF;
constexpr std::size_t kMaxText = 4 * std::size_t{kMaxViewWidth};
constexpr std::size_t kMaxLabel = 256;
constexpr std::size_t kMaxNote = 4 * kMaxChatLength;
/// Limits of lists; more than fit in a frame, except for the keys of Objects that vanish.
constexpr std::size_t kMaxObjects = kMaxSlots;
constexpr std::size_t kMaxVanished = 4 * std::size_t{kMaxSlots};
constexpr std::int64_t kMaxShake = 1000;
constexpr std::int64_t kMost32 = std::numeric_limits<std::uint32_t>::max();
/// Limit of a sequence, in bytes; longer than any sequence that fits in a snapshot.
constexpr std::size_t kMaxSequence = std::size_t{1} << 20;

std::uint32_t numberOf(const std::unordered_map<const void*, std::uint32_t>& numbers, const void* p_thing,
                       std::uint32_t none) {
  const auto found = numbers.find(p_thing);
  return found != numbers.end() ? found->second : none;
}

std::string spell(const Sequence& sequence) {
  BitWriter bits;
  writeSequence(bits, sequence);
  return bits.bytes();
}

bool isEncodable(const Look& look) {
  return !look.sequence.empty() && look.sequence.size() <= kMaxFrames &&
         look.sequence.glyphCount() <= kMaxGlyphs && look.selector.fits(look.sequence.size());
}

/// Returns the selector for a world whose tick numbers are higher by `later`.
Selector delayed(Selector selector, std::uint32_t later) {
  if (selector.kind == Selector::kClock || selector.kind == Selector::kClockOnce) selector.start += later;
  if (selector.kind == Selector::kAngle) selector.angle -= static_cast<std::uint32_t>(selector.spin) * later;
  return selector;
}

}  // namespace

/// The fields of each part of a view. One function both writes and reads them.
struct ViewFields {
  template <class F, class T>
  static void key(F& f, T& key) {
    f.number(key.slot);
    f.number(key.generation);
  }
  template <class F, class T>
  static void box(F& f, T& box) {
    visitVector(f, box.corner, kMaxPosition);
    visitVector(f, box.size, kMaxPosition);
    if constexpr (F::kReads) f.require(box.size.x >= 0 && box.size.y >= 0);
  }
  template <class F, class T>
  static void color(F& f, T& color) {
    f.number(color, df::BLACK, df::WHITE);
  }

  template <class F, class T>
  static void object(F& f, T& facts) {
    key(f, facts.key);
    f.number(facts.order, 0, kMaxOrder);
    visitVector(f, facts.position, kMaxPosition);
    visitVector(f, facts.velocity, df::kMaxVelocity);
    visitVector(f, facts.acceleration, df::kMaxVelocity);
    box(f, facts.box);
    f.number(facts.solidness, df::HARD, df::SPECTRAL);
    f.flag(facts.no_soft);
    f.flag(facts.shown);
    f.flag(facts.on_view);
    f.number(facts.altitude, 0, df::MAX_ALTITUDE);
    if constexpr (F::kReads) f.require(facts.key.generation != 0);
  }
  template <class F, class T>
  static void command(F& f, T& command) {
    visitVector(f, command.position, kMaxPosition);
    f.number(command.ch, 0, kLastCharacter);
    color(f, command.color);
    if constexpr (F::kReads) f.require(df::isDrawable(command.ch));
  }
  template <class F, class T>
  static void drawn(F& f, T& drawn) {
    key(f, drawn.key);
    f.number(drawn.first);
    f.number(drawn.count);
    f.flag(drawn.on_view);
  }
  template <class F, class T>
  static void sound(F& f, T& sound) {
    f.text(sound.label, kMaxLabel);
    f.number(sound.what, df::SoundPlayed::kPlay, df::SoundPlayed::kStop);
    f.flag(sound.music);
    f.flag(sound.loop);
    f.number(sound.player);
  }
  template <class F, class T>
  static void text(F& f, T& text) {
    f.number(text.id, 0, kMaxTexts - 1);
    f.number(text.x, 0, kMaxViewWidth - 1);
    f.number(text.y, 0, kMaxViewHeight - 1);
    color(f, text.color);
    f.text(text.text, kMaxText);
  }
  template <class F, class T>
  static void lever(F& f, T& lever) {
    f.fixed(lever.target_velocity, df::kMaxControlReach);
    f.flag(lever.is_released);
  }
  template <class F, class T>
  static void control(F& f, T& state) {
    f.flag(state.steering);
    lever(f, state.x);
    lever(f, state.y);
    f.number(state.silence, 0, df::kMaxControlTicks);
    for (auto& wait : state.wait) f.number(wait, 0, df::kMaxControlTicks);
  }
  template <class F, class Tables, class T>
  static void steering(F& f, Tables& tables, T& steering) {
    bool steers = steering.p_table != nullptr;
    f.flag(steers);
    if (!steers) return;
    table(f, tables, steering.p_table);
    key(f, steering.object);
    control(f, steering.state);
    visitVector(f, steering.position, kMaxPosition);
    visitVector(f, steering.velocity, df::kMaxVelocity);
    visitVector(f, steering.acceleration, df::kMaxVelocity);
  }
  template <class F, class Tables, class T>
  static void player(F& f, Tables& tables, T& player) {
    f.number(player.id, 1, kMost32);
    f.text(player.name, kMaxNameBytes);
    color(f, player.color);
    f.number(player.score, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
    key(f, player.followed);
    visitVector(f, player.view_corner, kMaxCorner);
    f.list(player.texts, kMaxTexts, [](F& in, auto& element) { text(in, element); });
    steering(f, tables, player.steering);
  }
  template <class F, class T>
  static void selector(F& f, T& selector) {
    f.number(selector.kind, Selector::kFixed, Selector::kAngle);
    f.number(selector.frame, 0, kMaxFrames - 1);
    f.number(selector.ticks_per_frame, 1, kMaxTicksPerFrame);
    f.number(selector.start);
    f.number(selector.angle);
    f.number(selector.spin, std::numeric_limits<std::int32_t>::min(),
             std::numeric_limits<std::int32_t>::max());
  }
  template <class F, class Tables, class T>
  static void view(F& f, Tables& tables, T& view) {
    f.number(view.tick);
    box(f, view.boundary);
    f.number(view.view_width, kMinViewWidth, kMaxViewWidth);
    f.number(view.view_height, kMinViewHeight, kMaxViewHeight);
    f.list(view.changed, kMaxObjects, [](F& in, auto& element) { object(in, element); });
    f.list(view.vanished, kMaxVanished, [](F& in, auto& element) { key(in, element); });
    f.list(view.commands, kMaxObjects, [](F& in, auto& element) { command(in, element); });
    f.list(view.drawn, kMaxObjects, [](F& in, auto& element) { drawn(in, element); });
    looks(f, tables, view);
    f.list(view.players, kMaxViewPlayers, [&tables](F& in, auto& element) { player(in, tables, element); });
    visitVector(f, view.corner, kMaxCorner);
    f.list(view.sounds, df::WorldExtras::kMaxSounds, [](F& in, auto& element) { sound(in, element); });
    f.number(view.sounds_lost);
    f.list(view.playing, df::WorldExtras::kMaxPlaying, [](F& in, auto& element) { sound(in, element); });
    f.list(view.notes, df::WorldExtras::kMaxNotes, [](F& in, auto& element) { in.text(element, kMaxNote); });
    f.number(view.background, df::UNDEFINED_COLOR, df::CUSTOM);
    f.number(view.shake_x, -kMaxShake, kMaxShake);
    f.number(view.shake_y, -kMaxShake, kMaxShake);
  }

  // Parts that are sent in full once, with the next free number, and only by that number afterwards.

  static void table(FieldWriter& out, ViewWriter& known,
                    const std::shared_ptr<const df::ControlTable>& p_table) {
    const auto fresh = static_cast<std::uint32_t>(known.m_kept_tables.size());
    const std::uint32_t number = numberOf(known.m_tables, p_table.get(), fresh);
    out.number(number);
    if (number != fresh) return;
    std::string bytes;
    writeControlTable(bytes, *p_table);
    out.text(bytes, kMaxControlTableBytes);
    known.m_tables.emplace(p_table.get(), fresh);
    known.m_kept_tables.push_back(p_table);
  }
  static void table(FieldReader& in, ViewReader& known, std::shared_ptr<const df::ControlTable>& p_table) {
    std::uint32_t number = 0;
    in.number(number, 0, static_cast<std::int64_t>(known.m_tables.size()));
    if (in.ok() && number == known.m_tables.size()) {
      std::string bytes;
      in.text(bytes, kMaxControlTableBytes);
      auto read = readControlTable(bytes);
      in.require(read.has_value());
      if (read) known.m_tables.push_back(std::make_shared<const df::ControlTable>(*std::move(read)));
    }
    if (in.ok()) p_table = known.m_tables[number];
  }
  static void sequence(FieldWriter& out, ViewWriter& known, const Sequence& sequence) {
    const auto fresh = static_cast<std::uint32_t>(known.m_kept_sequences.size());
    const std::uint32_t number = numberOf(known.m_sequences, sequence.identity(), fresh);
    out.number(number);
    if (number != fresh) return;
    out.text(spell(sequence), kMaxSequence);
    known.m_sequences.emplace(sequence.identity(), fresh);
    known.m_kept_sequences.push_back(sequence);
  }
  static void sequence(FieldReader& in, ViewReader& known, Sequence& sequence) {
    std::uint32_t number = 0;
    in.number(number, 0, static_cast<std::int64_t>(known.m_sequences.size()));
    if (in.ok() && number == known.m_sequences.size()) {
      std::string bytes;
      in.text(bytes, kMaxSequence);
      BitReader bits(bytes);
      Sequence read = readSequence(bits);
      in.require(bits.atEnd() && !read.empty());
      if (in.ok()) known.m_sequences.push_back(std::move(read));
    }
    if (in.ok()) sequence = known.m_sequences[number];
  }
  // Looks that do not fit in a snapshot are omitted, because the characters that draw() drew are sent anyway.
  static void looks(FieldWriter& out, ViewWriter& known, const df::WorldView& view) {
    std::vector<df::PublishedLook> encodable;
    for (const df::PublishedLook& look : view.looks) {
      if (isEncodable(*look.p_look)) encodable.push_back(look);
    }
    out.list(encodable, kMaxObjects, [&known](FieldWriter& f, const df::PublishedLook& look) {
      f.number(look.drawn);
      f.number(look.p_look->altitude, 0, df::MAX_ALTITUDE);
      selector(f, look.p_look->selector);
      sequence(f, known, look.p_look->sequence);
    });
  }
  static void looks(FieldReader& in, ViewReader& known, df::WorldView& view) {
    in.list(view.looks, kMaxObjects, [&known](FieldReader& f, df::PublishedLook& published) {
      Look look;
      f.number(published.drawn);
      f.number(look.altitude, 0, df::MAX_ALTITUDE);
      selector(f, look.selector);
      sequence(f, known, look.sequence);
      f.require(look.selector.fits(look.sequence.size()));
      look.selector = delayed(look.selector, known.m_tick_offset);
      published.p_look = std::make_shared<const Look>(std::move(look));
    });
  }
  /// True if the parts of a view match each other.
  static bool fits(const df::WorldView& view) {
    for (const df::DrawnObject& drawn : view.drawn) {
      if (std::uint64_t{drawn.first} + drawn.count > view.commands.size()) return false;
    }
    const auto rises = [](const auto& all, auto value_of) {
      return std::adjacent_find(all.begin(), all.end(), [&](const auto& a, const auto& b) {
               return value_of(a) >= value_of(b);
             }) == all.end();
    };
    if (!view.looks.empty() && view.looks.back().drawn >= view.drawn.size()) return false;
    return rises(view.looks, [](const df::PublishedLook& look) { return look.drawn; }) &&
           rises(view.players, [](const df::PlayerFacts& player) { return player.id; }) &&
           std::all_of(view.players.begin(), view.players.end(), [&](const df::PlayerFacts& player) {
             return rises(player.texts, [](const df::PlayerText& text) { return text.id; });
           });
  }
};

void ViewWriter::write(FieldWriter& out, const df::WorldView& view) {
  const bool forgets = m_kept_sequences.size() > kMaxViewNumbers || m_kept_tables.size() > kMaxViewNumbers;
  if (forgets) *this = ViewWriter();
  out.flag(forgets);
  ViewFields::view(out, *this, view);
}

void ViewReader::read(FieldReader& in, df::WorldView& view) {
  bool forgets = false;
  in.flag(forgets);
  if (forgets) *this = ViewReader(m_tick_offset);
  in.require(m_sequences.size() <= kMaxViewNumbers && m_tables.size() <= kMaxViewNumbers);
  ViewFields::view(in, *this, view);
  if (in.ok()) in.require(ViewFields::fits(view));
  view.tick += m_tick_offset;
}

}  // namespace naiad
