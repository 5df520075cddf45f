// What a command gives back.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace naiad {

using AdminValue = std::variant<std::string, std::int64_t, double, bool>;
/// Values by name, in the order in which they are shown.
using AdminRow = std::vector<std::pair<std::string, AdminValue>>;

struct AdminAnswer {
  bool ok = true;
  std::string text;                     ///< one sentence, or empty; what is wrong if not ok
  std::vector<std::string> candidates;  ///< what an ambiguous name may have meant
  AdminRow facts;                       ///< of the server
  bool is_list = false;                 ///< `rows` is the answer, though it may be empty
  std::vector<AdminRow> rows;           ///< each with the same names

  /// Returns the answer to a command that succeeded.
  static AdminAnswer done(std::string text) { return {true, std::move(text), {}, {}, false, {}}; }
  /// Returns these rows, or the sentence `if_empty` if there are none.
  static AdminAnswer list(std::vector<AdminRow> rows, std::string if_empty) {
    std::string text = rows.empty() ? std::move(if_empty) : std::string();
    return {true, std::move(text), {}, {}, true, std::move(rows)};
  }
  /// Returns the answer to a command that did nothing; `text` gives the reason.
  static AdminAnswer refused(std::string text) { return {false, std::move(text), {}, {}, false, {}}; }
};

/// Lines for people: the sentence; facts as "name: value"; rows under a line of headings, in columns. Control
/// characters are escaped: names and reasons come from strangers.
std::vector<std::string> answerText(const AdminAnswer& answer);

/// "yes", "3", "0.25" or the text itself.
std::string valueText(const AdminValue& value);

}  // namespace naiad
