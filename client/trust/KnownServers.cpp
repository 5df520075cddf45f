#include "client/trust/KnownServers.h"

#include <system_error>

#include "client/trust/PinLines.h"
#include "client/trust/ServerAddress.h"
#include "shared/net/base/SafeFile.h"
#include "shared/net/base/UserDirectory.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFile = std::size_t{4} * 1024 * 1024;  // bytes; some 40,000 servers

std::string nameOf(const std::string& host, std::uint16_t port) {
  return ServerAddress{host, port}.canonicalText();
}

PinLines readLines(const fs::path& path) {
  return PinLines(readSmallFile(path, kMaxFile).value_or(""));
}

std::string warning(const std::string& server, const Fingerprint& expected, const Fingerprint& seen,
                    const fs::path& path) {
  return "THE KEY OF " + server +
         " HAS CHANGED. Somebody may be listening in, or its host made a new key. "
         "Not connected. Ask the host: if the key is " +
         seen.text() + " now, join with --fingerprint " + seen.text() + " once. (" + path.string() +
         " says " + expected.text() + ".)";
}

Verdict judgeBy(const PinLines& lines, const std::string& server, const PeerFacts& facts,
                const std::optional<Fingerprint>& given, const std::optional<ShortKey>& link,
                const fs::path& path) {
  if (link && *link != ShortKey::of(facts.key)) {
    return {Trust::kLinkUnequal,
            server + " does not have the key of the link: it shows " + ShortKey::of(facts.key).text() +
                ". Not connected, and nothing was sent. Compare the end of the link with the one "
                "the host gave you."};
  }
  if (given && *given == facts.key) return {Trust::kGivenEqual, server + " has the key that was given."};
  if (given) {
    return {Trust::kGivenUnequal,
            server + " does not have the key that was given: it shows " + facts.key.text() +
                ". Not connected. Compare the fingerprint with the line the host gave you."};
  }
  if (facts.chain_verifies) return {Trust::kChain, server + " has a certificate that verifies."};
  const auto pinned = lines.find(server);
  if (!pinned && link) return {Trust::kLinkEqual, server + " has the key of the link."};
  if (!pinned) {
    return {Trust::kFirstUse,
            "First visit to " + server + ": its key " + facts.key.text() +
                " is trusted from now on. (No certificate that verifies: " + facts.chain_problem + ".)"};
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
  throw KnownServersError("No place for the file of known servers: neither HOME nor XDG_DATA_HOME is set.");
}

Verdict KnownServers::judge(const std::string& host, std::uint16_t port, const PeerFacts& facts,
                            const std::optional<Fingerprint>& given,
                            const std::optional<ShortKey>& link) const {
  return inWords([&] { return judgeBy(readLines(path_), nameOf(host, port), facts, given, link, path_); });
}

Verdict KnownServers::admit(const std::string& host, std::uint16_t port, const PeerFacts& facts,
                            const std::optional<Fingerprint>& given,
                            const std::optional<ShortKey>& link) const {
  return inWords([&] {
    const std::string server = nameOf(host, port);
    const PinLines seen = readLines(path_);
    Verdict first = judgeBy(seen, server, facts, given, link, path_);
    // Nothing to write: no lock either, so that a home directory that is read-only does not matter.
    if (!first.accepted() || seen.find(server) == facts.key) return first;
    if (path_.has_parent_path()) fs::create_directories(path_.parent_path());
    const FileLock lock(path_.string() + ".lock");
    PinLines lines = readLines(path_);
    Verdict verdict = judgeBy(lines, server, facts, given, link, path_);
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
                          " is not \"host:port fingerprint\"; it is kept, and not used.");
    }
    return sentences;
  });
}

}  // namespace naiad
