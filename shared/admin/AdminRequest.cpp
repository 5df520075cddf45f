#include "shared/admin/AdminRequest.h"

#include <algorithm>
#include <utility>

#include "shared/options/Duration.h"
#include "shared/options/Options.h"

namespace naiad {

namespace {

using Kind = AdminArgument::Kind;

/// Maximum length of an argument in bytes.
constexpr std::size_t kMaxAdminArgument = 1024;

bool isOneOf(const AdminArgument& argument, const std::string& value) {
  return std::find(argument.one_of.begin(), argument.one_of.end(), value) != argument.one_of.end();
}

std::string undashed(const std::string& word) {
  return word.starts_with("--") ? word.substr(2) : word;
}

/// True if the word is a valid value for this optional argument. A number before a text is a part of the
/// text: "ban ann 2 many insults" bans forever.
bool fits(const AdminCommand& command, const AdminArgument& argument, const std::string& word) {
  const bool is_text = command.arguments.back().kind == Kind::kText &&
                       word.find_first_not_of("0123456789.") == std::string::npos;
  if (argument.kind == Kind::kSpan) return !is_text && readTimeSpan(word);
  if (argument.kind == Kind::kChoice) return isOneOf(argument, undashed(word));
  return true;
}

void checkArgument(const AdminCommand& command, const AdminArgument& argument, const std::string& value) {
  const std::string where = command.name + ": \"" + value + "\"";
  if (value.size() > kMaxAdminArgument)
    throw AdminUsageError(command.name + ": " + argument.name + " is too long.");
  if (argument.kind == Kind::kSpan && !readTimeSpan(value))
    throw AdminUsageError(where + " is not a time span like 90, 30m, 2h or 7d.");
  if (argument.kind == Kind::kChoice && !isOneOf(argument, value)) {
    std::string all;
    for (const std::string& one : argument.one_of) all += (all.empty() ? "" : ", ") + one;
    throw AdminUsageError(where + " is not one of: " + all + ".");
  }
  if (value.empty() && (argument.required || argument.named) && argument.kind != Kind::kSecret)
    throw AdminUsageError(command.name + ": " + argument.name + " is empty.");
}

/// Returns the argument that a word --NAME or --NAME=VALUE names; nullptr for other words.
const AdminArgument* findNamed(const AdminCommand& command, const std::string& word) {
  const std::string name = undashed(word.substr(0, word.find('=')));
  const auto found = std::find_if(
      command.arguments.begin(), command.arguments.end(),
      [&name](const AdminArgument& argument) { return argument.named && argument.name == name; });
  return word.starts_with("--") && found != command.arguments.end() ? &*found : nullptr;
}

bool hasNamed(const AdminCommand& command) {
  return std::any_of(command.arguments.begin(), command.arguments.end(),
                     [](const AdminArgument& argument) { return argument.named; });
}

/// Moves the named arguments into the request. Returns the other words.
std::vector<std::string> takeNamed(AdminRequest& request, const std::vector<std::string>& words) {
  if (!hasNamed(*request.command)) return words;
  std::vector<std::string> others;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const AdminArgument* p_argument = findNamed(*request.command, word);
    if (p_argument == nullptr && word.starts_with("--"))
      throw AdminUsageError(request.command->name + " has no option " + word +
                            ". Usage: " + adminUsage(*request.command));
    if (p_argument == nullptr) {
      others.push_back(word);
    } else if (const std::size_t equals = word.find('='); equals != std::string::npos) {
      request.arguments[p_argument->name] = word.substr(equals + 1);
    } else if (i + 1 < words.size()) {
      request.arguments[p_argument->name] = words[++i];
    } else {
      throw AdminUsageError(word + " requires a value.");
    }
  }
  return others;
}

AdminRequest check(AdminRequest request) {
  const AdminCommand& command = *request.command;
  for (const AdminArgument& argument : command.arguments) {
    const auto given = request.arguments.find(argument.name);
    if (given == request.arguments.end()) {
      if (argument.required) throw AdminUsageError("Usage: " + adminUsage(command));
    } else {
      checkArgument(command, argument, given->second);
    }
  }
  return request;
}

}  // namespace

std::string AdminRequest::of(const std::string& name) const {
  const auto found = arguments.find(name);
  return found != arguments.end() ? found->second : std::string();
}

std::string AdminRequest::redacted() const {
  std::string text = command->name;
  for (const AdminArgument& argument : command->arguments) {
    const auto given = arguments.find(argument.name);
    if (given == arguments.end()) continue;
    text += argument.kind == Kind::kSecret ? " ***" : " \"" + given->second + "\"";
  }
  return text;
}

const AdminCommand& requireAdminCommand(const std::string& name) {
  if (const AdminCommand* p_command = findAdminCommand(name)) return *p_command;
  std::vector<std::string> names;
  for (const AdminCommand& command : adminCommands()) names.push_back(command.name);
  const std::string near = nearestName(name, names);
  throw AdminUsageError("There is no command \"" + name + "\"" +
                        (near.empty() ? "." : "; did you mean \"" + near + "\"?"));
}

AdminRequest readAdminRequest(const std::vector<std::string>& line) {
  if (line.empty()) throw AdminUsageError("A command is missing.");
  AdminRequest request{&requireAdminCommand(line.front()), {}};
  const std::vector<std::string> words = takeNamed(request, line);
  std::size_t next = 1;
  for (const AdminArgument& argument : request.command->arguments) {
    if (next == words.size()) break;
    if (argument.named) continue;
    if (!argument.required && !fits(*request.command, argument, words[next])) continue;
    std::string& value = request.arguments[argument.name];
    value = argument.kind == Kind::kChoice ? undashed(words[next]) : words[next];
    ++next;
    if (argument.kind != Kind::kText) continue;
    for (; next < words.size(); ++next) value += " " + words[next];
  }
  if (next < words.size()) throw AdminUsageError("Usage: " + adminUsage(*request.command));
  return check(std::move(request));
}

AdminRequest readAdminRequest(const std::string& command, std::map<std::string, std::string> arguments) {
  AdminRequest request{&requireAdminCommand(command), std::move(arguments)};
  const auto& known = request.command->arguments;
  const auto unknown =
      std::find_if(request.arguments.begin(), request.arguments.end(), [&known](const auto& given) {
        return std::none_of(known.begin(), known.end(),
                            [&given](const auto& one) { return one.name == given.first; });
      });
  if (unknown != request.arguments.end())
    throw AdminUsageError("Command \"" + command + "\" has no argument \"" + unknown->first + "\".");
  return check(std::move(request));
}

std::vector<std::string> splitAdminLine(std::string_view line) {
  std::vector<std::string> words;
  bool in_word = false;
  bool quoted = false;
  for (const char c : line) {
    const bool is_blank = !quoted && (c == ' ' || c == '\t');
    if (!is_blank && !in_word) words.emplace_back();
    in_word = !is_blank;
    if (c == '"') quoted = !quoted;
    if (!is_blank && c != '"') words.back() += c;
  }
  return words;
}

}  // namespace naiad
