// Wire messages without the protobuf library: the base of the classes that protoc-gen-small generates.
//
// They have the names and the behaviour of protobuf's lite classes, as far as a client needs them, and depend
// only on the standard library. A table of fields per class drives one reader and one writer, so machine code
// does not grow with the schema. Differences from protobuf: unknown fields are dropped, not kept; a
// moved-from message may only be assigned to, cleared or destroyed; repeated fields are containers or views.
//
// Encoding: https://protobuf.dev/programming-guides/encoding/
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace naiad::small {

struct FieldTable;

/// The base of all messages. Not thread-safe.
class Message {
 public:
  virtual ~Message() = default;

  /// Replaces the content by the decoded bytes. Returns false if they are malformed; the content is then
  /// unspecified. Skips fields that the schema lacks, or has with another wire type.
  bool ParseFromArray(const void* data, int size);
  bool ParseFromString(std::string_view bytes);
  /// Returns the bytes that protobuf writes: fields by ascending number, defaults omitted.
  std::string SerializeAsString() const;
  /// Resets all fields to their defaults.
  void Clear();

  /// Returns the fields of the class. Its name cannot clash with a schema's fields, which have no capitals.
  virtual const FieldTable& fieldTable() const = 0;

  /// Makes this a deep copy of `other`, which must be of this class.
  void copyFrom(const Message& other);

 protected:
  Message() = default;
  Message(const Message&) = default;
  Message& operator=(const Message&) = default;
};

/// A field that is a message; null: not set.
using Child = std::unique_ptr<Message>;
/// A repeated field of messages.
using Children = std::vector<Child>;

/// Returns the message of this field; creates it if it is not set.
Message& mutableChild(Child& child, const FieldTable& fields);

/// The members of a `oneof`, of which at most one is set: strings, bytes and messages.
class Oneof {
 public:
  Oneof() = default;
  Oneof(Oneof&& other) noexcept
      : m_number(std::exchange(other.m_number, 0)),
        m_text(std::move(other.m_text)),
        m_child(std::move(other.m_child)) {}
  Oneof& operator=(Oneof&& other) noexcept {
    m_number = std::exchange(other.m_number, 0);
    m_text = std::move(other.m_text);
    m_child = std::move(other.m_child);
    return *this;
  }

  /// The number of the set field; 0: none.
  std::uint32_t number() const { return m_number; }
  void clear();

  /// Returns the text of this field; empty if it is not set.
  const std::string& text(std::uint32_t number) const;
  /// Returns the message of the set field; null if there is none.
  const Message* child() const { return m_child.get(); }

  /// Returns the value of this field. If it is not set, clears the set field and sets this one to its
  /// default.
  std::string& mutableText(std::uint32_t number);
  Message& mutableChild(std::uint32_t number, const FieldTable& fields);

 private:
  std::uint32_t m_number = 0;
  std::string m_text;
  Child m_child;
};

/// A view of a repeated field's messages, as objects of their class. Valid as long as the message with the
/// field.
template <class Element>
class RepeatedView {
 public:
  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Element;
    using difference_type = std::ptrdiff_t;
    using pointer = const Element*;
    using reference = const Element&;

    Iterator() = default;
    explicit Iterator(Children::const_iterator at) : m_at(at) {}
    const Element& operator*() const { return static_cast<const Element&>(**m_at); }
    const Element* operator->() const { return &**this; }
    Iterator& operator++() {
      ++m_at;
      return *this;
    }
    Iterator operator++(int) { return Iterator(m_at++); }
    bool operator==(const Iterator&) const = default;

   private:
    Children::const_iterator m_at;
  };

  explicit RepeatedView(const Children& children) : m_children(&children) {}
  Iterator begin() const { return Iterator(m_children->begin()); }
  Iterator end() const { return Iterator(m_children->end()); }
  int size() const { return static_cast<int>(m_children->size()); }
  bool empty() const { return m_children->empty(); }
  const Element& operator[](int index) const { return static_cast<const Element&>(*(*m_children)[index]); }

 private:
  const Children* m_children;
};

/// The types of the schema language that the generator supports.
enum class Type : std::uint8_t {
  kUint32,
  kSint32,
  kBool,
  kFixed32,
  kFixed64,
  kEnum,
  kString,  ///< UTF-8; anything else is malformed
  kBytes,
  kMessage,
};

/// The cardinality of a field, which decides where it is stored.
enum class Cardinality : std::uint8_t { kSingle, kRepeated, kOneof };

/// One field of a class: a line of its table.
struct Field {
  /// The member that holds the value. All numbers of up to 32 bits, signed or not, use one kind of member.
  union Member {
    std::uint32_t Message::*word;
    std::uint64_t Message::*wide;
    std::string Message::*text;
    Child Message::*child;
    std::vector<std::uint32_t> Message::*words;
    std::vector<std::string> Message::*texts;
    Children Message::*children;
    Oneof Message::*oneof;
  };

  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, std::uint32_t Owner::*m) : number(n), type(t) {
    member.word = static_cast<std::uint32_t Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, std::uint64_t Owner::*m) : number(n), type(t) {
    member.wide = static_cast<std::uint64_t Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, std::string Owner::*m) : number(n), type(t) {
    member.text = static_cast<std::string Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, Child Owner::*m, const FieldTable& f)
      : number(n), type(t), fields(&f) {
    member.child = static_cast<Child Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, std::vector<std::uint32_t> Owner::*m)
      : number(n), type(t), cardinality(Cardinality::kRepeated) {
    member.words = static_cast<std::vector<std::uint32_t> Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, std::vector<std::string> Owner::*m)
      : number(n), type(t), cardinality(Cardinality::kRepeated) {
    member.texts = static_cast<std::vector<std::string> Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, Children Owner::*m, const FieldTable& f)
      : number(n), type(t), cardinality(Cardinality::kRepeated), fields(&f) {
    member.children = static_cast<Children Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, Oneof Owner::*m)
      : number(n), type(t), cardinality(Cardinality::kOneof) {
    member.oneof = static_cast<Oneof Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, Oneof Owner::*m, const FieldTable& f)
      : number(n), type(t), cardinality(Cardinality::kOneof), fields(&f) {
    member.oneof = static_cast<Oneof Message::*>(m);
  }

  std::uint32_t number;
  Type type;
  Cardinality cardinality = Cardinality::kSingle;
  const FieldTable* fields = nullptr;  ///< the fields of a message's class
  Member member{};
};

/// The description of a class for the reader and the writer.
struct FieldTable {
  const Field* begin;  ///< by ascending number
  const Field* end;
  Child (*make)();  ///< creates a message of the class
};

}  // namespace naiad::small
