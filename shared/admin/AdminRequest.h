// One command with its arguments, parsed from the words of a shell command line or a chat line, or from JSON.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "shared/admin/AdminCommands.h"

namespace naiad {

/// Thrown for an invalid command. what() is one sentence that gives the reason.
class AdminUsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A request checked against the table: the command exists, and its arguments are complete and valid.
struct AdminRequest {
  const AdminCommand* command = nullptr;
  std::map<std::string, std::string> arguments;  ///< values by name, without omitted arguments

  /// Returns the argument's text; empty if the argument was omitted.
  std::string of(const std::string& name) const;
  bool has(const std::string& name) const { return arguments.contains(name); }
  /// Returns the command for logs and history: secrets as "***", all other arguments in quotes.
  std::string redacted() const;
};

/// Like findAdminCommand(), but for an unknown name throws AdminUsageError, which suggests a similar one.
const AdminCommand& requireAdminCommand(const std::string& name);

/// Parses a command's words, name first. Throws AdminUsageError.
AdminRequest readAdminRequest(const std::vector<std::string>& words);
/// Like readAdminRequest(words), but takes the arguments by name.
AdminRequest readAdminRequest(const std::string& command, std::map<std::string, std::string> arguments);

/// Splits a line at blanks into words; "in quotes" is one word. Later, a text argument that takes the rest of
/// the line joins its words with single blanks.
std::vector<std::string> splitAdminLine(std::string_view line);

}  // namespace naiad
