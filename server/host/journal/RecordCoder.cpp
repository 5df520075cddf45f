#include "host/journal/RecordCoder.h"

#include <algorithm>

namespace naiad {

namespace {

/// Returns 4096 / (1 + e^(-x / 256)), interpolated between 33 points.
int squash(int x) {
  static constexpr int kPoints[33] = {1,    2,    3,    6,    10,   16,   27,   45,   73,   120,  194,
                                      310,  488,  747,  1101, 1546, 2047, 2549, 2994, 3348, 3607, 3785,
                                      3901, 3975, 4022, 4050, 4068, 4079, 4085, 4089, 4092, 4093, 4094};
  if (x > 2047) return 4095;
  if (x < -2047) return 0;
  const int weight = x & 127;
  const int at = (x >> 7) + 16;
  return (kPoints[at] * (128 - weight) + kPoints[at + 1] * weight + 64) >> 7;
}

/// Returns the inverse of squash() as a table.
const std::array<std::int16_t, 4096>& stretches() {
  static const auto table = [] {
    std::array<std::int16_t, 4096> all{};
    int next = 0;
    for (int x = -2047; x <= 2047; ++x) {
      const int value = squash(x);
      for (; next <= value; ++next) all[static_cast<std::size_t>(next)] = static_cast<std::int16_t>(x);
    }
    for (; next < 4096; ++next) all[static_cast<std::size_t>(next)] = 2047;
    return all;
  }();
  return table;
}

constexpr int kWeightBits = 16;
constexpr int kRate = 10;  ///< learning rate of the mixer
constexpr std::uint32_t kMaxPlace = 31;
constexpr std::uint32_t kTurnKind = 1;      ///< m_kind of kRecordedTurn (TurnRecord.h)
constexpr std::uint32_t kBeforeInputs = 1;  ///< bytes of a turn's record before its inputs

/// Updates until a probability's step size is constant, and the step size after each number of updates.
constexpr std::uint16_t kMaxCount = 60;
constexpr auto kReciprocals = [] {
  std::array<std::int32_t, kMaxCount + 1> all{};
  for (int i = 0; i <= kMaxCount; ++i) all[static_cast<std::size_t>(i)] = 65'536 / (i + 2);
  return all;
}();

std::uint32_t mix(std::uint32_t hash, std::uint32_t value) {
  return (hash ^ value) * 0x9e3779b1u + 0x7f4a7c15u;
}

}  // namespace

struct RecordModel::Tables {
  /// Probability that a bit is 1, in 65,536ths, and the number of its updates.
  struct Slot {
    std::uint16_t probability = 32'768;
    std::uint16_t count = 0;
  };
  std::array<std::array<Slot, std::size_t{1} << kSlotBits>, kContexts> slots{};
  /// Indexed by kind of record and the bits of the byte so far.
  std::array<std::array<std::int32_t, kContexts>, std::size_t{4} * 256> weights{};
};

RecordModel::RecordModel() : m_tables(std::make_unique<Tables>()) {
  for (auto& weights : m_tables->weights) weights.fill((1 << kWeightBits) * 3 / 10);
  beginByte();
}

RecordModel::~RecordModel() = default;
RecordModel::RecordModel(RecordModel&& other) noexcept = default;

void RecordModel::beginByte() {
  const bool in_input = m_kind == kTurnKind && m_place > kBeforeInputs && m_left > 0;
  const std::uint32_t place = in_input
                                  ? m_field | m_input << 4 | 1u << 17
                                  : std::min(m_place, kMaxPlace) | m_kind << 8 | (m_left == 0 ? 1u << 16 : 0);
  const std::uint32_t last = m_history & 0xff;
  const std::uint32_t last_two = m_history & 0xffff;
  const std::uint32_t contexts[kContexts] = {
      place,
      last,
      last_two,
      m_history & 0xffffff,
      mix(place, last),
      mix(place, m_player << 8 | (m_left > 15 ? 15u : static_cast<std::uint32_t>(m_left)))};
  for (std::size_t i = 0; i < kContexts; ++i)
    m_hashes[i] = mix(mix(static_cast<std::uint32_t>(i) + 1, contexts[i]), contexts[i] >> 11);
}

std::uint32_t RecordModel::predict() {
  const auto& stretched = stretches();
  auto& weights = m_tables->weights[(m_kind & 3) << 8 | m_partial];
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < kContexts; ++i) {
    const std::uint32_t hash = mix(m_hashes[i], m_partial);
    m_slots[i] = hash >> (32 - kSlotBits);
    m_inputs[i] = stretched[m_tables->slots[i][m_slots[i]].probability >> 4];
    sum += static_cast<std::int64_t>(weights[i]) * m_inputs[i];
  }
  const int x = static_cast<int>(std::clamp<std::int64_t>(sum >> kWeightBits, -2047, 2047));
  m_predicted = static_cast<std::uint32_t>(squash(x));
  return std::clamp<std::uint32_t>(m_predicted << 4 | 8, 32, 65'535 - 32);
}

void RecordModel::update(bool bit) {
  const std::int32_t error = ((bit ? 4095 : 0) - static_cast<std::int32_t>(m_predicted)) * kRate;
  auto& weights = m_tables->weights[(m_kind & 3) << 8 | m_partial];
  for (std::size_t i = 0; i < kContexts; ++i) {
    weights[i] += (m_inputs[i] * error + 0x2000) >> 14;
    Tables::Slot& slot = m_tables->slots[i][m_slots[i]];
    // The probability adapts fast at first, and slowly after many updates.
    const std::int64_t step = (bit ? 65'535 : 0) - std::int64_t{slot.probability};
    slot.probability = static_cast<std::uint16_t>(slot.probability + (step * kReciprocals[slot.count] >> 16));
    if (slot.count < kMaxCount) ++slot.count;
  }
  m_partial = m_partial << 1 | (bit ? 1u : 0u);
  if (m_partial < 256) return;
  const auto byte = static_cast<std::uint8_t>(m_partial);
  m_partial = 1;
  m_history = m_history << 8 | byte;
  followRecord(byte);
  beginByte();
}

// Misreads a length of several bytes; packer and unpacker misread it alike, so this only costs bits.
void RecordModel::followRecord(std::uint8_t byte) {
  if (m_left == 0) {
    m_left = byte;
    m_place = 0;
    m_kind = 0;
    return;
  }
  if (m_place == 0) m_kind = 1 + (byte & 3);
  if (m_kind == kTurnKind && m_place >= kBeforeInputs) followInput(byte);
  ++m_place;
  --m_left;
}

// The first byte is the number of inputs. Like followRecord(), misreads numbers of more than one byte.
void RecordModel::followInput(std::uint8_t byte) {
  static constexpr std::uint32_t kLengths[4] = {2, 2, 4, 9};
  if (m_place == kBeforeInputs) {
    m_field = 0;
    m_player = 0;
    return;
  }
  if (m_field == 0) m_input = byte & 3;
  if (m_field == 1) m_player = byte;
  m_field = m_field + 1 >= kLengths[m_input] ? 0 : m_field + 1;
}

// The prediction splits the interval from low to high. Leading bytes that both ends share are written.
void RecordPacker::pack(std::string_view records, std::string& out) {
  std::uint32_t low = 0;
  std::uint32_t high = 0xffffffff;
  for (const char character : records) {
    const auto byte = static_cast<std::uint8_t>(character);
    for (int at = 7; at >= 0; --at) {
      const bool bit = (byte >> at & 1) != 0;
      const std::uint32_t middle =
          low + static_cast<std::uint32_t>(static_cast<std::uint64_t>(high - low) * m_model.predict() >> 16);
      bit ? high = middle : low = middle + 1;
      m_model.update(bit);
      for (; (low ^ high) >> 24 == 0; low <<= 8, high = high << 8 | 0xff)
        out.push_back(static_cast<char>(high >> 24));
    }
  }
  // The unpacker reads zeros after the last byte.
  if (low != 0) out.push_back(static_cast<char>((low >> 24) + 1));
}

void RecordUnpacker::unpack(std::string_view packed, std::size_t count, std::string& out) {
  std::size_t at = 0;
  const auto next = [&] {
    return at < packed.size() ? static_cast<std::uint8_t>(packed[at++]) : std::uint8_t{0};
  };
  std::uint32_t low = 0;
  std::uint32_t high = 0xffffffff;
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | next();
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t byte = 0;
    for (int bits = 0; bits < 8; ++bits) {
      const std::uint32_t middle =
          low + static_cast<std::uint32_t>(static_cast<std::uint64_t>(high - low) * m_model.predict() >> 16);
      const bool bit = value <= middle;
      bit ? high = middle : low = middle + 1;
      byte = byte << 1 | (bit ? 1u : 0u);
      m_model.update(bit);
      for (; (low ^ high) >> 24 == 0; low <<= 8, high = high << 8 | 0xff, value = value << 8 | next())
        continue;
    }
    out.push_back(static_cast<char>(byte));
  }
}

}  // namespace naiad
