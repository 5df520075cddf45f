// Reads a payload of the bus: one flat JSON object (RFC 8259) of kMaxBusPayload bytes at most. Payloads are
// as untrusted as a client's: what is missing, of another kind or out of range makes the whole unreadable.
// Members that are not known are left out, so that a fleet may have servers of two versions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>

namespace naiad {

inline constexpr std::size_t kMaxBusPayload = 2048;

class BusFields {
 public:
  explicit BusFields(std::string_view payload);

  /// All that was asked for was there and good.
  bool ok() const { return m_ok; }
  void fail() { m_ok = false; }

  bool has(const std::string& name) const { return m_values.contains(name); }

  // Of a member; fails, and is empty, for one that is not so.

  std::int64_t number(const std::string& name, std::int64_t least, std::int64_t most);
  bool flag(const std::string& name);
  /// Drawable characters only, `most` of them; an empty one is good.
  std::string line(const std::string& name, std::size_t most);
  /// As it stands, `most` bytes of printable ASCII.
  std::string word(const std::string& name, std::size_t most);

 private:
  using Value = std::variant<std::string, std::int64_t, bool>;
  friend class BusFieldsReader;

  template <class T>
  T take(const std::string& name);

  std::map<std::string, Value> m_values;
  bool m_ok = true;
};

}  // namespace naiad
