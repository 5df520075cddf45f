// Encodes a message.
#include "proto/small/Message.h"

namespace naiad::small {
namespace {

void addVarint(std::string& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out.push_back(static_cast<char>(value | 0x80));
  out.push_back(static_cast<char>(value));
}

void addFixed(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i)));
}

void addKey(std::string& out, const Field& field, std::uint32_t wire) {
  addVarint(out, std::uint64_t{field.number} << 3 | wire);
}

void addNumber(std::string& out, const Field& field, std::uint64_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  switch (field.type) {
    case Type::kFixed32:
      addKey(out, field, 5);
      return addFixed(out, value, 4);
    case Type::kFixed64:
      addKey(out, field, 1);
      return addFixed(out, value, 8);
    case Type::kSint32:  // zig-zag: 0, -1, 1, -2, 2
      value = (word << 1) ^ (0u - (word >> 31));
      break;
    case Type::kEnum:  // a negative number takes ten bytes
      value = static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(word)});
      break;
    default:
      break;
  }
  addKey(out, field, 0);
  addVarint(out, value);
}

void addSized(std::string& out, const Field& field, std::string_view bytes) {
  addKey(out, field, 2);
  addVarint(out, bytes.size());
  out += bytes;
}

void writeMessage(std::string& out, const Message& message);

void addMessage(std::string& out, const Field& field, const Message& message) {
  std::string bytes;
  writeMessage(bytes, message);
  addSized(out, field, bytes);
}

void addOneof(std::string& out, const Field& field, const Oneof& oneof) {
  if (oneof.number() != field.number) return;
  if (field.type == Type::kMessage) return addMessage(out, field, *oneof.child());
  addSized(out, field, oneof.text(field.number));
}

void addRepeated(std::string& out, const Field& field, const Message& message) {
  if (field.type == Type::kMessage) {
    for (const Child& child : message.*field.member.children) addMessage(out, field, *child);
  } else if (field.type == Type::kUint32) {
    std::string packed;
    for (const std::uint32_t word : message.*field.member.words) addVarint(packed, word);
    if (!packed.empty()) addSized(out, field, packed);
  } else {
    for (const std::string& text : message.*field.member.texts) addSized(out, field, text);
  }
}

/// Writes a single field. Omits a field that has its default, and a message that was never set.
void addSingle(std::string& out, const Field& field, const Message& message) {
  if (field.type == Type::kMessage) {
    const Child& child = message.*field.member.child;
    if (child != nullptr) addMessage(out, field, *child);
  } else if (field.type == Type::kString || field.type == Type::kBytes) {
    const std::string& text = message.*field.member.text;
    if (!text.empty()) addSized(out, field, text);
  } else {
    const bool wide = field.type == Type::kFixed64;
    const std::uint64_t value = wide ? message.*field.member.wide : message.*field.member.word;
    if (value != 0) addNumber(out, field, value);
  }
}

void writeMessage(std::string& out, const Message& message) {
  const FieldTable& fields = message.fieldTable();
  for (const Field* field = fields.begin; field != fields.end; ++field) {
    switch (field->cardinality) {
      case Cardinality::kSingle:
        addSingle(out, *field, message);
        break;
      case Cardinality::kRepeated:
        addRepeated(out, *field, message);
        break;
      case Cardinality::kOneof:
        addOneof(out, *field, message.*field->member.oneof);
        break;
    }
  }
}

}  // namespace

std::string Message::SerializeAsString() const {
  std::string bytes;
  writeMessage(bytes, *this);
  return bytes;
}

}  // namespace naiad::small
