// Messages of the wire without the protobuf library: what the classes that protoc-gen-small writes have in
// common.
//
// They have the names and the meaning of protobuf's lite classes, as far as a client needs them, and depend
// on nothing but the standard library. One reader and one writer serve all of them, led by a table of fields
// per class, so that machine code does not grow with the schema. Differences from protobuf: unknown fields
// are dropped, not kept; a moved-from message may only be assigned to, cleared or destroyed; repeated fields
// are standard containers or views.
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

/// The base of all messages. Not thread-safe, as any value is not.
class Message {
 public:
  virtual ~Message() = default;

  /// Replaces the content by what `size` bytes say. False if they are malformed; the content is then
  /// unspecified. Fields that the schema does not have, or has with another wire type, are skipped.
  bool ParseFromArray(const void* data, int size);
  bool ParseFromString(std::string_view bytes);
  /// The bytes are those that protobuf writes: fields by ascending number, defaults left out.
  std::string SerializeAsString() const;
  /// Back to all defaults.
  void Clear();

  /// The fields of the class. Names with an inner capital cannot meet those of a schema's fields.
  virtual const FieldTable& fieldTable() const = 0;

  /// Makes this a deep copy of `other`, which must have the same class.
  void copyFrom(const Message& other);

 protected:
  Message() = default;
  Message(const Message&) = default;
  Message& operator=(const Message&) = default;
};

/// A field that is a message; null: not set.
using Child = std::unique_ptr<Message>;
/// A repeated field that has messages.
using Children = std::vector<Child>;

/// The message of this field, which is made if it is not set.
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

  /// The number of the field that is set; 0: none.
  std::uint32_t number() const { return m_number; }
  void clear();

  /// The text of this field; empty if it is not set.
  const std::string& text(std::uint32_t number) const;
  /// The message, whichever field it is of; null if there is none.
  const Message* child() const { return m_child.get(); }

  /// The value of this field. If it is not set, it is set to its default; what another field held is gone.
  std::string& mutableText(std::uint32_t number);
  Message& mutableChild(std::uint32_t number, const FieldTable& fields);

 private:
  std::uint32_t m_number = 0;
  std::string m_text;
  Child m_child;
};

/// A repeated field's messages with their class: what a getter returns. It refers to the message that it came
/// from.
template <class Element>
class View {
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

  explicit View(const Children& children) : m_children(&children) {}
  Iterator begin() const { return Iterator(m_children->begin()); }
  Iterator end() const { return Iterator(m_children->end()); }
  int size() const { return static_cast<int>(m_children->size()); }
  bool empty() const { return m_children->empty(); }
  const Element& operator[](int index) const { return static_cast<const Element&>(*(*m_children)[index]); }

 private:
  const Children* m_children;
};

/// The types of the schema language that the generator knows.
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

/// How often a field may be there, which decides where it is stored.
enum class Place : std::uint8_t { kSingle, kRepeated, kOneof };

/// One field of a class: a line of its table.
struct Field {
  /// Where the value is. Numbers of up to 32 bits, signed or not, share one kind of member.
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
      : number(n), type(t), place(Place::kRepeated) {
    member.words = static_cast<std::vector<std::uint32_t> Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, std::vector<std::string> Owner::*m)
      : number(n), type(t), place(Place::kRepeated) {
    member.texts = static_cast<std::vector<std::string> Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, Children Owner::*m, const FieldTable& f)
      : number(n), type(t), place(Place::kRepeated), fields(&f) {
    member.children = static_cast<Children Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, Oneof Owner::*m) : number(n), type(t), place(Place::kOneof) {
    member.oneof = static_cast<Oneof Message::*>(m);
  }
  template <class Owner>
  constexpr Field(std::uint32_t n, Type t, Oneof Owner::*m, const FieldTable& f)
      : number(n), type(t), place(Place::kOneof), fields(&f) {
    member.oneof = static_cast<Oneof Message::*>(m);
  }

  std::uint32_t number;
  Type type;
  Place place = Place::kSingle;
  const FieldTable* fields = nullptr;  ///< of a message, those of its class
  Member member{};
};

/// What the reader and the writer need to know of a class.
struct FieldTable {
  const Field* begin;  ///< by ascending number
  const Field* end;
  Child (*make)();  ///< a new message of the class
};

}  // namespace naiad::small
