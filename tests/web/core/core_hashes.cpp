// Prints a hash for each part of the core shared by clients and servers, over a long run of random worlds,
// inputs and arguments. The native build and the page's WebAssembly build, whose size_t has 32 bits, must
// print equal hashes (tests/web/core/compare).
#include <bit>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "client/world/EpochReplicas.h"
#include "client/world/Prediction.h"
#include "shared/math/Elementary.h"
#include "shared/replica/ControlCodec.h"
#include "shared/replica/PredictedObject.h"
#include "shared/values/SplitMix64.h"
#include "tests/shared/replica/RandomControls.h"
#include "tests/shared/replica/RandomRecords.h"
#include "tests/support/WriteSnapshot.h"

namespace {

using namespace naiad;

/// FNV-1a, 64 bits.
class Hash {
 public:
  void add(std::uint64_t value) {
    for (int i = 0; i < 8; ++i) addByte(value >> (8 * i) & 0xff);
  }
  void add(std::int64_t value) { add(static_cast<std::uint64_t>(value)); }
  void add(int value) { add(std::int64_t{value}); }
  void add(double value) {
    add(std::isnan(value) ? std::uint64_t{0x7ff8} : std::bit_cast<std::uint64_t>(value));
  }
  void add(df::FixedVector v) {
    add(v.x);
    add(v.y);
  }
  void add(std::string_view bytes) {
    add(std::uint64_t{bytes.size()});
    for (const char c : bytes) addByte(static_cast<unsigned char>(c));
  }
  void add(const df::Canvas& canvas) {
    add(canvas.width());
    for (int y = 0; y < canvas.height(); ++y) {
      for (int x = 0; x < canvas.width(); ++x) {
        add(std::uint64_t{canvas.at(x, y).ch});
        add(static_cast<int>(canvas.at(x, y).color));
      }
    }
  }
  std::uint64_t value() const { return m_value; }

 private:
  void addByte(std::uint64_t byte) { m_value = (m_value ^ byte) * 0x100000001b3; }

  std::uint64_t m_value = 0xcbf29ce484222325;
};

/// Exits if a condition is false, because the results could not be compared then.
void require(bool is_so, const char* what) {
  if (is_so) return;
  std::printf("failed: %s\n", what);
  std::exit(1);
}

Hash math() {
  SplitMix64 random(4);
  Hash hash;
  const auto argument = [&random](int i) {
    const double any = std::bit_cast<double>(random.next());
    return i % 2 == 0 && std::isfinite(any) ? any : 60 * random.unit() - 30;
  };
  for (int i = 0; i < 20'000; ++i) {
    const double x = argument(i);
    const double y = argument(i + 1);
    for (double (*const function)(double) :
         {df::math::exp, df::math::expm1, df::math::log, df::math::log1p, df::math::sin, df::math::cos,
          df::math::tanh, df::math::sinh, df::math::cosh, df::math::atan, df::math::asin, df::math::acos})
      hash.add(function(x));
    hash.add(df::math::atan2(y, x));
  }
  return hash;
}

/// Returns a hash of a client's replica: its state and its picture.
Hash replica() {
  test::RandomRecords random(21);
  EpochReplicas feed({0, 1000, 0});
  Hash hash;
  for (std::uint32_t i = 1; i <= 1500; ++i) {
    SnapshotHeader header;
    header.number = i;
    header.tick = 1000 + i;
    SnapshotHeader seen;
    const std::string bytes = test::writeSnapshot(header, random.records(header.tick));
    hash.add(std::string_view(bytes));
    const auto result = feed.applySnapshot(bytes, EpochReplicas::Time(), seen, [](std::uint32_t) {});
    require(result == EpochReplicas::Result::kApplied || result == EpochReplicas::Result::kShown,
            "a snapshot is applied");
    hash.add(feed.shown().checksum());
    if (i % 30 != 0) continue;
    for (const std::uint32_t ahead : {0u, 7u, 40u}) hash.add(feed.shown().render(header.tick + ahead));
  }
  return hash;
}

/// Returns a hash of control tables and states, and of the effect of keys on them.
Hash controls() {
  SplitMix64 random(5);
  Hash hash;
  for (int i = 0; i < 2000; ++i) {
    const df::ControlTable table = test::randomTable(random);
    const ControlRecord record = test::randomControlRecord(random, 1000);
    std::string bytes;
    writeControlTable(bytes, table);
    writeControlRecord(bytes, record);
    hash.add(std::string_view(bytes));
    PredictedObject copy(record, table);
    for (int tick = 0; tick < 20; ++tick) {
      copy.beginTick();
      const auto key = table.rows.empty() ? df::Keyboard::A : table.rows[random.below(table.rows.size())].key;
      copy.applyKey(key, static_cast<df::EventKeyboardAction>(random.below(3)));
      copy.finishTick();
      hash.add(copy.position());
      hash.add(copy.velocity());
    }
  }
  return hash;
}

/// Returns a hash of the predictions of the player's own object, beyond the snapshots and among other
/// objects.
Hash prediction() {
  constexpr std::uint32_t kTick = 1000;
  constexpr std::uint32_t kOwn = 7;
  SplitMix64 random(6);
  Hash hash;
  for (std::uint32_t round = 1; round <= 200; ++round) {
    Snapshot snapshot;
    snapshot.header.number = round;
    snapshot.header.tick = kTick;
    for (std::uint32_t id = 0; id < 40; ++id) {
      ObjectRecord object{id, 1, kAllGroups, {}};
      object.state.order = id;
      const auto cell = [&random] { return df::fromCells(static_cast<std::int64_t>(random.below(20))); };
      const df::Fixed x = cell();
      object.state.motion = {kTick, {x, cell()}, {static_cast<df::Fixed>(random.below(1u << 31)), 0}, {}};
      object.state.look.sequence = {{Glyph{0, 0, U'@', df::WHITE}}};
      object.state.body = {{{}, {df::kFixedOne, df::kFixedOne}}, df::HARD, false};
      snapshot.records.objects.push_back(object);
    }
    Replica replica(kTick);
    replica.apply(snapshot);
    Prediction prediction;
    df::ControlTable table = test::randomTable(random);
    for (df::ControlRow& row : table.rows) row.key = df::Keyboard::A;
    prediction.setTable(table);
    ControlRecord own = test::randomControlRecord(random, kTick);
    own.slot = kOwn;
    own.generation = 1;
    own.newest_input = 0;
    own.position = {df::fromCells(10), df::fromCells(10)};
    prediction.applyControl(own);
    for (std::uint32_t id = 1; id <= 20; ++id)
      prediction.addInput({id, kTick + 2 * id, round, false, static_cast<std::uint8_t>(random.below(3)),
                           df::Keyboard::A, 0, 0, 0});
    for (const std::uint32_t ahead : {1u, 12u, 45u}) {
      prediction.run(replica, kTick + ahead);
      hash.add(static_cast<int>(prediction.isActive()));
      hash.add(prediction.position());
      hash.add(prediction.velocity());
    }
  }
  return hash;
}

}  // namespace

int main() {
  const struct {
    const char* name;
    Hash (*hash)();
  } parts[] = {{"math", math}, {"replica", replica}, {"controls", controls}, {"prediction", prediction}};
  for (const auto& [name, hash] : parts) std::printf("%s %016" PRIx64 "\n", name, hash().value());
  return 0;
}
