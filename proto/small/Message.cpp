// The functions of a message except reading and writing.
#include "proto/small/Message.h"

#include <type_traits>

namespace naiad::small {
namespace {

/// Calls `action` with the field's pointer to member.
template <class Action>
void withMember(const Field& field, Action action) {
  const bool repeated = field.cardinality == Cardinality::kRepeated;
  if (field.cardinality == Cardinality::kOneof) return action(field.member.oneof);
  switch (field.type) {
    case Type::kString:
    case Type::kBytes:
      return repeated ? action(field.member.texts) : action(field.member.text);
    case Type::kMessage:
      return repeated ? action(field.member.children) : action(field.member.child);
    case Type::kFixed64:
      return action(field.member.wide);
    default:
      return repeated ? action(field.member.words) : action(field.member.word);
  }
}

template <class Value>
void copy(Value& to, const Value& from, const Field&) {
  to = from;
}

void copy(Child& to, const Child& from, const Field& field) {
  to.reset();
  if (from != nullptr) mutableChild(to, *field.fields).copyFrom(*from);
}

void copy(Children& to, const Children& from, const Field& field) {
  to.clear();
  for (const Child& child : from) copy(to.emplace_back(), child, field);
}

/// Copies the oneof if `field` is its set member. Called for each member, because each has a line in the
/// table.
void copy(Oneof& to, const Oneof& from, const Field& field) {
  if (from.number() == 0) to.clear();
  if (from.number() != field.number) return;
  to.clear();
  if (field.type == Type::kMessage) {
    to.mutableChild(field.number, *field.fields).copyFrom(*from.child());
  } else {
    to.mutableText(field.number) = from.text(field.number);
  }
}

}  // namespace

Message& mutableChild(Child& child, const FieldTable& fields) {
  if (child == nullptr) child = fields.make();
  return *child;
}

void Oneof::clear() {
  m_number = 0;
  m_text.clear();
  m_child.reset();
}

const std::string& Oneof::text(std::uint32_t number) const {
  static const std::string none;
  return m_number == number ? m_text : none;
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

void Message::Clear() {
  for (const Field* field = fieldTable().begin; field != fieldTable().end; ++field) {
    withMember(*field, [this](auto member) {
      using Value = std::remove_reference_t<decltype(this->*member)>;
      this->*member = Value();
    });
  }
}

void Message::copyFrom(const Message& other) {
  if (this == &other) return;
  for (const Field* field = fieldTable().begin; field != fieldTable().end; ++field) {
    withMember(*field, [&](auto member) { copy(this->*member, other.*member, *field); });
  }
}

}  // namespace naiad::small
