#include "shared/replica/SnapshotCodec.h"

#include <algorithm>
#include <cassert>

#include "shared/replica/Acks.h"
#include "shared/replica/ControlCodec.h"
#include "shared/replica/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad {

// The layout, drawn out in PROTOCOL.md:
//
//   snapshot  number 16 | tick 16 | epoch 2 | complete 1 | has input 1 (input 16, age 6) | origin slot 2
//             | extras 1 | objects: exp-Golomb(3) | order of ids 4, if any | each object
//   extras    rare ones 1 (world 1, view 1, table 1, origins 2, texts 5, then these records) | control 1
//   table     length 10 | bytes (ControlCodec.h)
//   control   newest input 16, unless the header has it | state (ControlCodec.h)
//   object    id − previous id − 1: exp-Golomb(order) | kind | parts
//   kind      00 motion, 01 look, 10 birth, 110 death, 111 and a bit each for motion, look, body
//   birth     generation 2 | order − origin's: signed exp-Golomb(10) | motion | look | body
namespace {

constexpr int kLowBits = 16;
constexpr int kAgeBits = 6;
constexpr int kObjectCountOrder = 3;
constexpr int kIdOrderBits = 4;
constexpr int kOrderOrder = 10;
constexpr std::int64_t kMaxOrder = std::int64_t{1} << 48;
constexpr int kTableLengthBits = 10;
constexpr int kTextXOrder = 6;
constexpr int kTextYOrder = 4;
constexpr int kTextLengthOrder = 5;
constexpr std::size_t kMaxTextCharacters = kMaxViewWidth;

/// The first two bits of an object's record, the first one lowest.
enum Prefix : std::uint8_t { kJustMotion = 0b00, kJustLook = 0b10, kBirth = 0b01, kElse = 0b11 };

int idOrder(std::uint32_t last_id, std::size_t count) {
  const auto gap = static_cast<std::uint32_t>(last_id / std::max<std::size_t>(count, 1));
  return std::clamp(static_cast<int>(std::bit_width(gap)) - 1, 0, (1 << kIdOrderBits) - 1);
}

/// Writes the size in 64 bits, because the size of a boundary may exceed the largest position.
void writeBox(BitWriter& out, const df::FixedBox& box) {
  writeVector(out, box.corner);
  out.bits(static_cast<std::uint64_t>(box.size.x), 64);
  out.bits(static_cast<std::uint64_t>(box.size.y), 64);
}

df::FixedBox readBox(BitReader& in) {
  df::FixedBox box;
  box.corner = readVector(in, kMaxWirePosition);
  box.size.x = static_cast<df::Fixed>(in.bits(64));
  box.size.y = static_cast<df::Fixed>(in.bits(64));
  if (box.size.x < 0 || box.size.y < 0) in.fail();
  return box;
}

WorldRecord readWorld(BitReader& in) {
  WorldRecord record;
  record.boundary = readBox(in);
  record.view_width = static_cast<std::int32_t>(in.bits(9));
  record.view_height = static_cast<std::int32_t>(in.bits(9));
  record.background = readColor(in);
  if (record.view_width < kMinViewWidth || record.view_height < kMinViewHeight ||
      record.view_width > kMaxViewWidth || record.view_height > kMaxViewHeight) {
    in.fail();
  }
  return record;
}

constexpr int kFollowedIdOrder = 6;

ViewRecord readView(BitReader& in) {
  ViewRecord record;
  record.corner = readVector(in, kMaxWirePosition);
  record.follows = in.flag();
  if (!record.follows) return record;
  record.id = static_cast<std::uint32_t>(in.golomb(kFollowedIdOrder, kMaxSlots - 1));
  record.generation = static_cast<std::uint8_t>(in.bits(2));
  return record;
}

OriginRecord readOrigin(BitReader& in) {
  OriginRecord record;
  record.slot = static_cast<std::uint32_t>(in.bits(2));
  if (record.slot == 0) in.fail();
  record.origin.corner.x = static_cast<std::int32_t>(in.signedBits(32));
  record.origin.corner.y = static_cast<std::int32_t>(in.signedBits(32));
  record.origin.x_bits = static_cast<std::int32_t>(in.bits(4));
  record.origin.y_bits = static_cast<std::int32_t>(in.bits(4));
  record.origin.order = in.bits(48);
  return record;
}

TextRecord readText(BitReader& in) {
  TextRecord record;
  record.id = static_cast<std::uint32_t>(in.bits(4));
  record.x = static_cast<std::int32_t>(in.signedGolomb(kTextXOrder, kMaxViewWidth));
  record.y = static_cast<std::int32_t>(in.signedGolomb(kTextYOrder, kMaxViewHeight));
  record.color = readColor(in);
  const std::uint64_t length = in.golomb(kTextLengthOrder, kMaxTextCharacters);
  for (std::uint64_t i = 0; i < length && in.ok(); ++i) df::appendUtf8(record.text, readCharacter(in));
  return record;
}

/// Reads the objects of one snapshot; its looks may refer to sequences that it defines.
class ObjectReader {
 public:
  ObjectReader(BitReader& in, const SnapshotHeader& header, const Origin& origin,
               const SnapshotDictionary& dictionary, Records& records)
      : m_in(in), m_header(header), m_origin(origin), m_dictionary(dictionary), m_records(records) {}

  void read() {
    const std::uint64_t count = m_in.golomb(kObjectCountOrder, m_in.remainingBits());
    const int order = count > 0 ? static_cast<int>(m_in.bits(kIdOrderBits)) : 0;
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < count && m_in.ok(); ++i) {
      const std::uint64_t id = next + m_in.golomb(order, kMaxSlots);
      if (id >= kMaxSlots) return m_in.fail();
      next = id + 1;
      ObjectRecord& record = m_records.objects.emplace_back();
      record.id = static_cast<std::uint32_t>(id);
      readParts(record);
    }
    if (m_in.ok()) resolve();
  }
  bool isStale() const { return m_stale; }

 private:
  void readParts(ObjectRecord& record) {
    record.groups = readGroups();
    if ((record.groups & kLife) != 0) {
      record.generation = static_cast<std::uint8_t>(m_in.bits(2));
      const std::int64_t order =
          static_cast<std::int64_t>(m_origin.order) + m_in.signedGolomb(kOrderOrder, kMaxOrder);
      if (order < 0 || order >= kMaxOrder) m_in.fail();
      record.state.order = static_cast<std::uint64_t>(order);
    }
    if ((record.groups & kMotion) != 0) record.state.motion = readMotion(m_in, m_header.tick, m_origin);
    if ((record.groups & kLook) != 0) record.state.look = readNamedLook();
    if ((record.groups & kBody) != 0) record.state.body = readBody(m_in);
  }

  std::uint8_t readGroups() {
    const std::uint64_t prefix = m_in.bits(2);
    if (prefix == kJustMotion) return kMotion;
    if (prefix == kJustLook) return kLook;
    if (prefix == kBirth) return kAllGroups;
    if (!m_in.flag()) return kDeath;
    const auto groups = static_cast<std::uint8_t>(m_in.bits(3) << 1);
    if (groups == 0) m_in.fail();
    return groups;
  }

  Look readNamedLook() {
    return readLook(
        m_in, m_header.tick,
        [this](std::uint32_t id, const Sequence& sequence) {
          m_records.sequences.push_back({id, sequence});
        },
        [this](std::uint32_t id) {
          m_named.push_back({m_records.objects.size() - 1, id});
          return nullptr;
        });
  }

  // Looks up the named sequences. Objects are sorted by their ids, so a sequence may be used before the
  // object that defines it.
  void resolve() {
    for (const auto& [object, id] : m_named) {
      const Sequence* sequence = find(id);
      if (sequence == nullptr) continue;
      Look& look = m_records.objects[object].state.look;
      look.sequence = *sequence;
      if (!look.selector.isCanonical(m_header.tick, look.sequence.size())) m_in.fail();
    }
  }

  const Sequence* find(std::uint32_t id) {
    for (const SequenceRecord& defined : m_records.sequences) {
      if (defined.id == id) return &defined.sequence;
    }
    const Sequence* sequence = nullptr;
    const SnapshotDictionary::Find found = m_dictionary.find(m_header.number, id, sequence);
    if (found == SnapshotDictionary::Find::kStale) m_stale = true;
    if (found == SnapshotDictionary::Find::kUnknown) m_in.fail();
    return found == SnapshotDictionary::Find::kFound ? sequence : nullptr;
  }

  BitReader& m_in;
  const SnapshotHeader& m_header;
  const Origin& m_origin;
  const SnapshotDictionary& m_dictionary;
  Records& m_records;
  std::vector<std::pair<std::size_t, std::uint32_t>> m_named;  ///< object indices, and sequence ids
  bool m_stale = false;
};

SnapshotHeader readHeader(BitReader& in, const SnapshotContext& context) {
  SnapshotHeader header;
  header.number = expandSerial(in.bits(kLowBits), context.number);
  header.tick = expandSerial(in.bits(kLowBits), context.tick);
  header.epoch = static_cast<std::uint8_t>(in.bits(2));
  header.complete = in.flag();
  header.has_input = in.flag();
  if (header.has_input) {
    header.input = expandSerial(in.bits(kLowBits), context.input);
    header.input_tick = header.tick - static_cast<std::uint32_t>(in.bits(kAgeBits));
  }
  if (header.number == 0) in.fail();
  return header;
}

df::ControlTable readTable(BitReader& in) {
  const std::uint64_t length = in.bits(kTableLengthBits);
  std::string bytes;
  for (std::uint64_t i = 0; i < length && in.ok(); ++i) bytes.push_back(static_cast<char>(in.bits(8)));
  const std::optional<df::ControlTable> table = readControlTable(bytes);
  if (!table) in.fail();
  return table.value_or(df::ControlTable{});
}

void readRareExtras(BitReader& in, Records& records) {
  const bool world = in.flag();
  const bool view = in.flag();
  const bool table = in.flag();
  const std::uint64_t origins = in.bits(2);
  const std::uint64_t texts = in.bits(5);
  if (texts > kMaxTexts) in.fail();
  if (world) records.worlds.push_back(readWorld(in));
  if (view) records.views.push_back(readView(in));
  if (table) records.tables.push_back(readTable(in));
  for (std::uint64_t i = 0; i < origins && in.ok(); ++i) records.origins.push_back(readOrigin(in));
  for (std::uint64_t i = 0; i < texts && in.ok(); ++i) records.texts.push_back(readText(in));
}

void readExtras(BitReader& in, const SnapshotContext& context, const Origin& origin, Snapshot& out) {
  if (in.flag()) readRareExtras(in, out.records);
  if (!in.flag()) return;
  const SnapshotHeader& header = out.header;
  const std::uint32_t input =
      header.has_input ? header.input : expandSerial(in.bits(kLowBits), context.input);
  out.records.controls.push_back(readControlRecord(in, header.tick, origin));
  out.records.controls.back().newest_input = input;
}

}  // namespace

ReadResult readSnapshot(std::string_view bytes, const SnapshotContext& context,
                        const SnapshotDictionary& dictionary, Snapshot& out) {
  out = {};
  BitReader in(bytes);
  out.header = readHeader(in, context);
  Origin origin;
  const auto known = dictionary.find(out.header.number, static_cast<std::uint32_t>(in.bits(2)), origin);
  if (known == SnapshotDictionary::Find::kUnknown || !in.ok()) return ReadResult::kMalformed;
  if (known == SnapshotDictionary::Find::kStale) return ReadResult::kStale;
  if (in.flag()) readExtras(in, context, origin, out);
  ObjectReader objects(in, out.header, origin, dictionary, out.records);
  objects.read();
  if (!in.atEnd()) return ReadResult::kMalformed;
  return objects.isStale() ? ReadResult::kStale : ReadResult::kOk;
}

std::optional<SnapshotHeader> peekHeader(std::string_view bytes, const SnapshotContext& context) {
  BitReader in(bytes);
  const SnapshotHeader header = readHeader(in, context);
  return in.ok() ? std::optional(header) : std::nullopt;
}

std::optional<std::uint8_t> peekEpoch(std::string_view bytes) {
  BitReader in(bytes);
  in.bits(2 * kLowBits);
  const auto epoch = static_cast<std::uint8_t>(in.bits(2));
  if (!in.ok()) return std::nullopt;
  return epoch;
}

void SnapshotWriter::beginSnapshot(const SnapshotHeader& header, std::uint32_t slot, const Origin& origin) {
  m_header = header;
  m_origin_slot = slot;
  m_origin = origin;
  for (BitWriter* part : {&m_world, &m_view, &m_table, &m_origins, &m_texts, &m_control}) part->clear();
  m_origin_count = m_text_count = 0;
  m_objects.clear();
  m_encoded.clear();
  m_kept = 0;
  m_bits = kHeaderBits;
}

void SnapshotWriter::write(const WorldRecord& record) {
  assert(m_world.bitCount() == 0);
  writeBox(m_world, record.boundary);
  m_world.bits(static_cast<std::uint64_t>(record.view_width), 9);
  m_world.bits(static_cast<std::uint64_t>(record.view_height), 9);
  writeColor(m_world, record.background);
  m_bits += m_world.bitCount();
}

void SnapshotWriter::write(const ViewRecord& record) {
  assert(m_view.bitCount() == 0);
  writeVector(m_view, record.corner);
  m_view.flag(record.follows);
  if (record.follows) {
    m_view.golomb(record.id, kFollowedIdOrder);
    m_view.bits(record.generation, 2);
  }
  m_bits += m_view.bitCount();
}

void SnapshotWriter::write(const OriginRecord& record) {
  const std::size_t before = m_origins.bitCount();
  ++m_origin_count;
  m_origins.bits(record.slot, 2);
  m_origins.signedBits(record.origin.corner.x, 32);
  m_origins.signedBits(record.origin.corner.y, 32);
  m_origins.bits(static_cast<std::uint64_t>(record.origin.x_bits), 4);
  m_origins.bits(static_cast<std::uint64_t>(record.origin.y_bits), 4);
  m_origins.bits(record.origin.order, 48);
  m_bits += m_origins.bitCount() - before;
}

void SnapshotWriter::write(const TextRecord& record) {
  const std::size_t before = m_texts.bitCount();
  ++m_text_count;
  m_texts.bits(record.id, 4);
  m_texts.signedGolomb(record.x, kTextXOrder);
  m_texts.signedGolomb(record.y, kTextYOrder);
  writeColor(m_texts, record.color);
  const std::u32string characters = df::decodeUtf8(record.text).substr(0, kMaxTextCharacters);
  m_texts.golomb(characters.size(), kTextLengthOrder);
  for (const char32_t ch : characters) writeCharacter(m_texts, ch);
  m_bits += m_texts.bitCount() - before;
}

void SnapshotWriter::writeTable(std::string_view bytes) {
  assert(m_table.bitCount() == 0 && bytes.size() <= kMaxControlTableBytes);
  m_table.bits(bytes.size(), kTableLengthBits);
  for (const char c : bytes) m_table.bits(static_cast<unsigned char>(c), 8);
  m_bits += m_table.bitCount();
}

void SnapshotWriter::write(const ControlRecord& record) {
  assert(m_control.bitCount() == 0 && record.tick == m_header.tick);
  assert(!m_header.has_input || m_header.input == record.newest_input);
  if (!m_header.has_input) m_control.bits(record.newest_input & 0xFFFF, kLowBits);
  writeControlRecord(m_control, record, m_origin);
  m_bits += m_control.bitCount();
}

void SnapshotWriter::encode(BitWriter& out, std::uint8_t groups, std::uint8_t generation,
                            const ObjectState& state, const Motion& motion, LookForm form) const {
  assert((groups & kMotion) == 0 || motion.tick == m_header.tick);
  encodeWith(out, groups, generation, state, motion, form);
}

template <class AnyMotion>
void SnapshotWriter::encodeWith(BitWriter& out, std::uint8_t groups, std::uint8_t generation,
                                const ObjectState& state, const AnyMotion& motion, LookForm form) const {
  assert((groups & kLife) == 0 || groups == kAllGroups);
  switch (groups) {
    case kMotion:
      out.bits(kJustMotion, 2);
      break;
    case kLook:
      out.bits(kJustLook, 2);
      break;
    case kAllGroups:
      out.bits(kBirth, 2);
      break;
    default:
      out.bits(kElse, 2);
      out.flag(groups != kDeath);
      if (groups != kDeath) out.bits(groups >> 1, 3);
  }
  if ((groups & kLife) != 0) {
    out.bits(generation, 2);
    out.signedGolomb(static_cast<std::int64_t>(state.order) - static_cast<std::int64_t>(m_origin.order),
                     kOrderOrder);
  }
  if ((groups & kMotion) != 0) writeMotion(out, motion, m_origin);
  if ((groups & kLook) != 0) writeLook(out, state.look, form, m_header.tick);
  if ((groups & kBody) != 0) writeBody(out, state.body);
}

void SnapshotWriter::object(std::uint32_t id, const BitWriter& bits) {
  m_encoded.append(bits);
  commit(id);
}

std::size_t SnapshotWriter::stage(std::uint8_t groups, std::uint8_t generation, const ObjectState& state,
                                  const SharedMotion& motion, LookForm form) {
  assert((groups & kMotion) == 0 || motion.motion.tick == m_header.tick);
  encodeWith(m_encoded, groups, generation, state, motion, form);
  return m_encoded.bitCount() - m_kept;
}

void SnapshotWriter::commit(std::uint32_t id) {
  const std::size_t bits = m_encoded.bitCount() - m_kept;
  m_objects.push_back({id, m_kept, bits});
  m_kept += bits;
  m_bits += bits;
}

// The gaps between n ids up to M have exp-Golomb codes of order k, which is about log2(M/n). They take k + 1
// bits each, and two more for each doubling of a gap beyond 2^k. The gaps add up to M, so there are fewer
// than 2n such doublings.
bool SnapshotWriter::hasSpace(std::size_t more, std::uint32_t last_id, std::size_t bytes) const {
  const std::size_t count = m_objects.size() + 1;
  const auto order = static_cast<std::size_t>(std::bit_width(last_id / count));
  return m_bits + more + count * (order + 5) <= 8 * bytes;
}

void SnapshotWriter::finishExtras() {
  const bool rare = m_world.bitCount() + m_view.bitCount() + m_table.bitCount() + m_origins.bitCount() +
                        m_texts.bitCount() >
                    0;
  const bool control = m_control.bitCount() > 0;
  m_out.flag(rare || control);
  if (!rare && !control) return;
  m_out.flag(rare);
  if (rare) {
    m_out.flag(m_world.bitCount() > 0);
    m_out.flag(m_view.bitCount() > 0);
    m_out.flag(m_table.bitCount() > 0);
    m_out.bits(m_origin_count, 2);
    m_out.bits(m_text_count, 5);
    for (const BitWriter* part : {&m_world, &m_view, &m_table, &m_origins, &m_texts}) m_out.append(*part);
  }
  m_out.flag(control);
  m_out.append(m_control);
}

void SnapshotWriter::finish(std::string& bytes) {
  m_out.clear();
  m_out.bits(m_header.number & 0xFFFF, kLowBits);
  m_out.bits(m_header.tick & 0xFFFF, kLowBits);
  m_out.bits(m_header.epoch, 2);
  m_out.flag(m_header.complete);
  m_out.flag(m_header.has_input);
  if (m_header.has_input) {
    constexpr std::uint32_t kMaxAge = (1u << kAgeBits) - 1;
    m_out.bits(m_header.input & 0xFFFF, kLowBits);
    m_out.bits(std::min(m_header.tick - m_header.input_tick, kMaxAge), kAgeBits);
  }
  m_out.bits(m_origin_slot, 2);
  finishExtras();
  const auto by_id = [](const Object& a, const Object& b) { return a.id < b.id; };
  if (!std::is_sorted(m_objects.begin(), m_objects.end(), by_id)) {
    std::sort(m_objects.begin(), m_objects.end(), by_id);
  }
  m_out.golomb(m_objects.size(), kObjectCountOrder);
  const int order = m_objects.empty() ? 0 : idOrder(m_objects.back().id, m_objects.size());
  if (!m_objects.empty()) m_out.bits(static_cast<std::uint64_t>(order), kIdOrderBits);
  std::uint32_t next = 0;
  for (const Object& object : m_objects) {
    m_out.golomb(object.id - next, order);
    m_out.append(m_encoded, object.from, object.bits);
    next = object.id + 1;
  }
  m_out.bytes(bytes);
}

}  // namespace naiad
