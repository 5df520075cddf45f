// One command with its arguments, read from words: of a shell's command line, or of a line of chat.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "shared/admin/AdminCommands.h"

namespace naiad {

/// A command that makes no sense; what() is one sentence.
class AdminUsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Checked against the table: its command is there, required arguments are given, choices and spans are some.
struct AdminRequest {
  const AdminCommand* command = nullptr;
  std::map<std::string, std::string> arguments;  ///< by name; those that were left out are not there

  /// The argument's text; empty if it was left out.
  std::string of(const std::string& name) const;
  bool has(const std::string& name) const { return arguments.contains(name); }
  /// The command for logs and history: secrets are "***", texts in quotes.
  std::string redacted() const;
};

/// Of the command's name and what follows. Throws AdminUsageError.
AdminRequest readAdminRequest(const std::vector<std::string>& words);
/// The same of arguments by name. Throws AdminUsageError.
AdminRequest readAdminRequest(const std::string& command, std::map<std::string, std::string> arguments);

/// The words of a line, separated by blanks; "in quotes" is one word. A text that takes the rest of a line
/// gets its words with single blanks between them.
std::vector<std::string> splitAdminLine(std::string_view line);

}  // namespace naiad
