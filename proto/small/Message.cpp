// What a message does with its fields apart from reading and writing them.
#include "proto/small/Message.h"

namespace naiad::small {

Message& mutableChild(Child& child, const FieldTable& fields) {
  if (child == nullptr) child = fields.make();
  return *child;
}

const std::string& Oneof::text(std::uint32_t number) const {
  static const std::string none;
  return m_number == number ? m_text : none;
}

void Oneof::clear() {
  m_number = 0;
  m_text.clear();
  m_child.reset();
}

std::string& Oneof::mutableText(std::uint32_t number) {
  if (m_number != number) {
    clear();
    m_number = number;
  }
  return m_text;
}

Message& Oneof::mutableChild(std::uint32_t number, const FieldTable& fields) {
  if (m_number != number) {
    clear();
    m_number = number;
    m_child = fields.make();
  }
  return *m_child;
}

namespace {

/// Makes `child` a copy of `other`, which may be null.
void copyChild(Child& child, const Message* other, const FieldTable& fields,
               void (*copy)(Message&, const Message&)) {
  child.reset();
  if (other == nullptr) return;
  child = fields.make();
  copy(*child, *other);
}

}  // namespace

void Message::Clear() {
  for (const Field* field = fieldTable().begin; field != fieldTable().end; ++field) {
    const Field::Member& member = field->member;
    if (field->place == Place::kOneof) {
      (this->*member.oneof).clear();
      continue;
    }
    const bool repeated = field->place == Place::kRepeated;
    switch (field->type) {
      case Type::kString:
      case Type::kBytes:
        if (repeated) {
          (this->*member.texts).clear();
        } else {
          (this->*member.text).clear();
        }
        break;
      case Type::kMessage:
        if (repeated) {
          (this->*member.children).clear();
        } else {
          (this->*member.child).reset();
        }
        break;
      case Type::kFixed64:
        this->*member.wide = 0;
        break;
      default:
        if (repeated) {
          (this->*member.words).clear();
        } else {
          this->*member.word = 0;
        }
    }
  }
}

void Message::copyFrom(const Message& other) {
  if (this == &other) return;
  const auto copy = [](Message& to, const Message& from) { to.copyFrom(from); };
  for (const Field* field = fieldTable().begin; field != fieldTable().end; ++field) {
    const Field::Member& member = field->member;
    const bool repeated = field->place == Place::kRepeated;
    if (field->place == Place::kOneof) {
      // Each member of the oneof has a line; the one that is set copies, the first of them clears.
      Oneof& to = this->*member.oneof;
      const Oneof& from = other.*member.oneof;
      if (from.number() == 0) to.clear();
      if (from.number() != field->number) continue;
      to.clear();
      if (field->type == Type::kMessage) {
        copy(to.mutableChild(field->number, *field->fields), *from.child());
      } else {
        to.mutableText(field->number) = from.text(field->number);
      }
      continue;
    }
    switch (field->type) {
      case Type::kString:
      case Type::kBytes:
        if (repeated) {
          this->*member.texts = other.*member.texts;
        } else {
          this->*member.text = other.*member.text;
        }
        break;
      case Type::kMessage:
        if (repeated) {
          Children& to = this->*member.children;
          to.clear();
          for (const Child& from : other.*member.children) {
            copyChild(to.emplace_back(), from.get(), *field->fields, copy);
          }
        } else {
          copyChild(this->*member.child, (other.*member.child).get(), *field->fields, copy);
        }
        break;
      case Type::kFixed64:
        this->*member.wide = other.*member.wide;
        break;
      default:
        if (repeated) {
          this->*member.words = other.*member.words;
        } else {
          this->*member.word = other.*member.word;
        }
    }
  }
}

}  // namespace naiad::small
