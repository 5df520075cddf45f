#include "client/trust/KnownServers.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <system_error>

#include "client/trust/ServerAddress.h"
#include "shared/net/base/SafeFile.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

// The lines of a file of known servers, in memory. KnownServers.h describes the format.

constexpr std::string_view kBlanks = " \t\r";

class PinLines {
 public:
  explicit PinLines(std::string_view content) {
    while (!content.empty()) {
      const std::size_t end = std::min(content.find('\n'), content.size());
      lines_.push_back(parse(content.substr(0, end)));
      content.remove_prefix(std::min(end + 1, content.size()));
    }
  }
  std::string content() const {
    std::string all;
    for (const Line& line : lines_) all += line.text + '\n';
    return all;
  }
  /// Returns the pinned key of `server` ("host:port", lower case): the last one, if there are several.
  std::optional<Fingerprint> find(std::string_view server) const {
    std::optional<Fingerprint> found;
    for (const Line& line : lines_) {
      if (line.key && line.server == server) found = line.key;
    }
    return found;
  }
  /// Makes `key` the only pin of `server`. Other lines do not change.
  void set(std::string_view server, const Fingerprint& key) {
    std::erase_if(lines_, [&](const Line& line) { return line.key && line.server == server; });
    lines_.push_back(parse(std::string(server) + ' ' + key.text()));
  }
  /// Returns the numbers, from 1, of the lines that are neither a pin nor a comment.
  std::vector<std::size_t> malformed() const {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!lines_[i].key && !isComment(lines_[i].text)) numbers.push_back(i + 1);
    }
    return numbers;
  }

 private:
  struct Line {
    std::string text;
    std::string server;  // empty: not a pin
    std::optional<Fingerprint> key;
  };

  static bool isComment(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    return first == std::string_view::npos || text[first] == '#';
  }
  static Line parse(std::string_view text) {
    Line line{std::string(text), "", std::nullopt};
    if (isComment(text)) return line;
    const std::size_t begin = text.find_first_not_of(kBlanks);
    const std::string_view rest = text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
    const std::size_t blank = rest.find_first_of(kBlanks);
    if (blank == std::string_view::npos) return line;
    const std::size_t second = rest.find_first_not_of(kBlanks, blank);
    const auto address = ServerAddress::parse(std::string(rest.substr(0, blank)));
    const auto key = Fingerprint::parse(rest.substr(second));
    // A pin is spelled as text() spells the address, because pins are compared as text.
    if (!address || !key || address->text() != rest.substr(0, blank)) return line;
    line.server = lowerCase(address->text());
    line.key = key;
    return line;
  }

  std::vector<Line> lines_;
};

namespace fs = std::filesystem;

constexpr std::size_t kMaxFile = std::size_t{4} * 1024 * 1024;  // bytes; about 40,000 servers

std::string nameOf(const std::string& host, std::uint16_t port) {
  return ServerAddress{host, port}.canonicalText();
}

PinLines readLines(const fs::path& path) {
  return PinLines(readSmallFile(path, kMaxFile).value_or(""));
}

std::string warning(const std::string& server, const Fingerprint& expected, const Fingerprint& seen,
                    const fs::path& path) {
  return "THE KEY OF " + server +
         " HAS CHANGED. The connection may be intercepted, or the host made a new key. Not connected. Ask "
         "the host: if the new key is " +
         seen.text() + ", join once with --fingerprint " + seen.text() + ". (" + path.string() +
         " has the old key " + expected.text() + ".)";
}

TrustResult verifyWith(const PinLines& lines, const std::string& server, const PeerIdentity& facts,
                       const std::optional<Fingerprint>& given, const std::optional<ShortKey>& link,
                       const fs::path& path) {
  if (link && *link != ShortKey::of(facts.key)) {
    return {Trust::kLinkMismatch, server + " does not have the key in the link: its key is " +
                                      ShortKey::of(facts.key).text() +
                                      ". Not connected, and nothing was sent. Compare the end of the link "
                                      "(after #) with the host's link."};
  }
  if (given && *given == facts.key) return {Trust::kFingerprintMatch, server + " has the given key."};
  if (given) {
    return {Trust::kFingerprintMismatch,
            server + " does not have the given key: its key is " + facts.key.text() +
                ". Not connected. Compare the fingerprint with the one the host gave you."};
  }
  if (facts.chain_verifies) return {Trust::kChain, server + " has a valid certificate."};
  const auto pinned = lines.find(server);
  if (!pinned && link) return {Trust::kLinkMatch, server + " has the key in the link."};
  if (!pinned) {
    return {Trust::kFirstUse, "First visit to " + server + ": its key " + facts.key.text() +
                                  " is trusted from now on. (No valid certificate: " + facts.chain_problem +
                                  ".)"};
  }
  if (*pinned == facts.key) return {Trust::kPinned, server + " has the key it had before."};
  return {Trust::kChanged, warning(server, *pinned, facts.key, path)};
}

template <class Action>
auto inWords(Action action) {
  try {
    return action();
  } catch (const std::system_error& error) {
    throw KnownServersError(std::string("The file of known servers cannot be used: ") + error.what() + ".");
  }
}

}  // namespace

fs::path KnownServers::defaultPath() {
  if (const auto directory = userDirectory("XDG_DATA_HOME", ".local/share"))
    return *directory / "known_servers";
  throw KnownServersError("Neither HOME nor XDG_DATA_HOME is set: specify --known-servers FILE.");
}

TrustResult KnownServers::verify(const std::string& host, std::uint16_t port, const PeerIdentity& facts,
                                 const std::optional<Fingerprint>& given,
                                 const std::optional<ShortKey>& link) const {
  return inWords([&] { return verifyWith(readLines(path_), nameOf(host, port), facts, given, link, path_); });
}

TrustResult KnownServers::admit(const std::string& host, std::uint16_t port, const PeerIdentity& facts,
                                const std::optional<Fingerprint>& given,
                                const std::optional<ShortKey>& link) const {
  return inWords([&] {
    const std::string server = nameOf(host, port);
    const PinLines seen = readLines(path_);
    TrustResult first = verifyWith(seen, server, facts, given, link, path_);
    // There is nothing to write, so no lock is taken, and the home directory may be read-only.
    if (!first.accepted() || seen.find(server) == facts.key) return first;
    if (path_.has_parent_path()) fs::create_directories(path_.parent_path());
    const FileLock lock(path_.string() + ".lock");
    PinLines lines = readLines(path_);
    TrustResult verdict = verifyWith(lines, server, facts, given, link, path_);
    if (verdict.accepted() && lines.find(server) != facts.key) {
      lines.set(server, facts.key);
      replaceFile(path_, lines.content());
    }
    return verdict;
  });
}

std::vector<std::string> KnownServers::problems() const {
  return inWords([&] {
    std::vector<std::string> sentences;
    for (const std::size_t number : readLines(path_).malformed()) {
      sentences.push_back("Line " + std::to_string(number) + " of " + path_.string() +
                          " is not \"host:port fingerprint\"; the line is ignored.");
    }
    return sentences;
  });
}

}  // namespace naiad
