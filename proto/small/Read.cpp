// Decodes a message. Accepts exactly what protobuf 3.21 does, including its oddities: a field's key and a
// length may have up to five bytes and a number ten, whatever their value; bits beyond the type's are
// dropped.
#include "proto/small/Message.h"
#include "proto/small/Utf8.h"

namespace naiad::small {
namespace {

/// Largest nesting depth of messages and unknown groups: protobuf's default.
constexpr int kMaxDepth = 100;

constexpr int kMaxKeyBytes = 5;
constexpr int kMaxLengthBytes = 5;
constexpr int kMaxVarintBytes = 10;

/// The low three bits of a field's key.
enum Wire : std::uint32_t {
  kVarint = 0,
  kEightBytes = 1,
  kSized = 2,
  kGroup = 3,
  kGroupEnd = 4,
  kFourBytes = 5
};

/// Returns the wire type of values of this type.
Wire wireOf(Type type) {
  switch (type) {
    case Type::kFixed32:
      return kFourBytes;
    case Type::kFixed64:
      return kEightBytes;
    case Type::kString:
    case Type::kBytes:
    case Type::kMessage:
      return kSized;
    default:
      return kVarint;
  }
}

/// The unread bytes. Functions return false if these are too few or malformed.
class Input {
 public:
  explicit Input(std::string_view bytes) : m_bytes(bytes) {}

  bool atEnd() const { return m_bytes.empty(); }

  bool takeVarint(std::uint64_t& value, int max_bytes = kMaxVarintBytes) {
    value = 0;
    for (int i = 0; i < max_bytes && !m_bytes.empty(); ++i) {
      const auto byte = static_cast<std::uint8_t>(m_bytes.front());
      m_bytes.remove_prefix(1);
      value |= std::uint64_t{byte & 0x7Fu} << (7 * i);
      if (byte < 0x80) return true;
    }
    return false;
  }

  bool takeKey(std::uint32_t& key) {
    std::uint64_t value = 0;
    if (!takeVarint(value, kMaxKeyBytes)) return false;
    key = static_cast<std::uint32_t>(value);
    return true;
  }

  bool takeBytes(std::uint64_t count, std::string_view& bytes) {
    if (count > m_bytes.size()) return false;
    bytes = m_bytes.substr(0, static_cast<std::size_t>(count));
    m_bytes.remove_prefix(bytes.size());
    return true;
  }

  bool takeSized(std::string_view& bytes) {
    std::uint64_t size = 0;
    return takeVarint(size, kMaxLengthBytes) && takeBytes(size, bytes);
  }

  /// Reads a number of any of the three wire types.
  bool takeNumber(Wire wire, std::uint64_t& value) {
    if (wire == kVarint) return takeVarint(value);
    std::string_view bytes;
    if (!takeBytes(wire == kFourBytes ? 4 : 8, bytes)) return false;
    value = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
    return true;
  }

  /// Skips an unknown value after its key.
  bool skip(std::uint32_t key, int depth) {
    std::uint64_t number = 0;
    std::string_view bytes;
    if (key >> 3 == 0) return false;
    switch (key & 7) {
      case kVarint:
      case kEightBytes:
      case kFourBytes:
        return takeNumber(static_cast<Wire>(key & 7), number);
      case kSized:
        return takeSized(bytes);
      case kGroup:
        return depth > 0 && skipGroup(key, depth - 1);
      default:
        return false;
    }
  }

 private:
  bool skipGroup(std::uint32_t start, int depth) {
    std::uint32_t key = 0;
    while (takeKey(key)) {
      if ((key & 7) == kGroupEnd) return key >> 3 == start >> 3;
      if (!skip(key, depth)) return false;
    }
    return false;
  }

  std::string_view m_bytes;
};

/// Converts a decoded number to the form in which a field stores it. Signed numbers keep their bits.
std::uint64_t stored(Type type, std::uint64_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  switch (type) {
    case Type::kFixed64:
      return value;
    case Type::kBool:
      return value != 0 ? 1 : 0;
    case Type::kSint32:  // zig-zag: 0, -1, 1, -2, 2
      return (word >> 1) ^ (0u - (word & 1));
    default:
      return word;
  }
}

bool readMessage(Input in, Message& message, int depth);

std::string& textOf(Message& message, const Field& field) {
  switch (field.cardinality) {
    case Cardinality::kRepeated:
      return (message.*field.member.texts).emplace_back();
    case Cardinality::kOneof:
      return (message.*field.member.oneof).mutableText(field.number);
    default:
      return message.*field.member.text;
  }
}

/// Returns the message to read into: the existing one, to merge with it, or a new one in a repeated field.
Message& childOf(Message& message, const Field& field) {
  if (field.cardinality == Cardinality::kOneof)
    return (message.*field.member.oneof).mutableChild(field.number, *field.fields);
  const bool repeated = field.cardinality == Cardinality::kRepeated;
  Child& child = repeated ? (message.*field.member.children).emplace_back() : message.*field.member.child;
  return mutableChild(child, *field.fields);
}

bool readNumber(Input& in, Message& message, const Field& field) {
  std::uint64_t value = 0;
  if (!in.takeNumber(wireOf(field.type), value)) return false;
  value = stored(field.type, value);
  if (field.cardinality == Cardinality::kRepeated) {
    (message.*field.member.words).push_back(static_cast<std::uint32_t>(value));
  } else if (field.type == Type::kFixed64) {
    message.*field.member.wide = value;
  } else {
    message.*field.member.word = static_cast<std::uint32_t>(value);
  }
  return true;
}

bool readSized(std::string_view bytes, Message& message, const Field& field, int depth) {
  if (field.type == Type::kMessage) {
    return depth > 0 && readMessage(Input(bytes), childOf(message, field), depth - 1);
  }
  if (field.type == Type::kString || field.type == Type::kBytes) {
    textOf(message, field).assign(bytes);
    return field.type == Type::kBytes || isUtf8(bytes);
  }
  Input packed(bytes);
  while (!packed.atEnd()) {
    if (!readNumber(packed, message, field)) return false;
  }
  return true;
}

const Field* find(const FieldTable& fields, std::uint32_t number) {
  for (const Field* field = fields.begin; field != fields.end; ++field) {
    if (field->number == number) return field;
  }
  return nullptr;
}

bool readMessage(Input in, Message& message, int depth) {
  while (!in.atEnd()) {
    std::uint32_t key = 0;
    if (!in.takeKey(key)) return false;
    const std::uint32_t wire = key & 7;
    const Field* field = find(message.fieldTable(), key >> 3);
    bool good = false;
    // Repeated numbers may be packed: many values in one field.
    if (field != nullptr && wire == kSized &&
        (wireOf(field->type) == kSized || field->cardinality == Cardinality::kRepeated)) {
      std::string_view bytes;
      good = in.takeSized(bytes) && readSized(bytes, message, *field, depth);
    } else if (field != nullptr && wire == wireOf(field->type)) {
      good = readNumber(in, message, *field);
    } else {
      good = in.skip(key, depth);
    }
    if (!good) return false;
  }
  return true;
}

}  // namespace

bool Message::ParseFromString(std::string_view bytes) {
  Clear();
  return readMessage(Input(bytes), *this, kMaxDepth);
}

bool Message::ParseFromArray(const void* data, int size) {
  return size >= 0 && ParseFromString({static_cast<const char*>(data), static_cast<std::size_t>(size)});
}

}  // namespace naiad::small
