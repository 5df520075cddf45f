#include "host/auth/ServerIdentity.h"

#include <openssl/ssl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "host/auth/SelfSigned.h"
#include "shared/net/base/SafeFile.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPem = 65'536;  // bytes of a key or a chain

std::string readKey(const fs::path& path) {
  const auto pem = readSmallFile(path, kMaxPem);
  if (!pem) throw TlsError("There is no key file " + path.string() + ".");
  if (openToOthers(path)) {
    throw TlsError("The key file " + path.string() + " can be read by other users. Run: chmod 600 " +
                   path.string());
  }
  return *pem;
}

std::string readCertificate(const fs::path& path) {
  const auto pem = readSmallFile(path, kMaxPem);
  if (!pem) throw TlsError("There is no certificate file " + path.string() + ".");
  return *pem;
}

/// What the system refused, as a sentence.
template <class Action>
auto inWords(Action action) {
  try {
    return action();
  } catch (const std::system_error& error) {
    throw TlsError(std::string("The server's key or certificate cannot be used: ") + error.what() + ".");
  }
}

/// Who can write in the key's folder can put another key there. Return a warning, or nothing.
std::string checkDirectory(const fs::path& directory) {
  struct stat facts {};
  if (::stat(directory.c_str(), &facts) != 0) return {};  // the next one to look says why
  const std::string cure = " Run: chmod go-w " + directory.string();
  if ((facts.st_mode & S_IWOTH) != 0) {
    throw TlsError("The folder " + directory.string() +
                   " has the server's key, and every user can write in it." + cure);
  }
  if ((facts.st_mode & S_IWGRP) != 0)
    return "the folder " + directory.string() + " has the server's key, and its group can write in it." +
           cure;
  if (facts.st_uid != ::geteuid() && facts.st_uid != 0)
    return "the folder " + directory.string() + " has the server's key, and belongs to another user.";
  return {};
}

void makeDirectory(const fs::path& directory) {
  if (fs::is_directory(directory)) return;
  fs::create_directories(directory);
  fs::permissions(directory, fs::perms::owner_all);
}

}  // namespace

fs::path ServerIdentity::defaultDirectory() {
  if (const auto directory = userDirectory("XDG_CONFIG_HOME", ".config")) return *directory;
  throw TlsError("No place for the server's key: neither HOME nor XDG_CONFIG_HOME is set.");
}

ServerIdentity ServerIdentity::loadOrMake(const fs::path& directory,
                                          std::chrono::system_clock::time_point now) {
  return inWords([&] {
    makeDirectory(directory);
    std::string warning = checkDirectory(directory);
    const fs::path key = directory / "key.pem";
    const fs::path certificate = directory / "certificate.pem";
    // Checked before the key: another process that starts at the same time makes the certificate last.
    const bool had_certificate = fs::exists(certificate);
    if (!fs::exists(key)) {
      if (had_certificate) {
        throw TlsError("The key " + key.string() +
                       " is missing, though its certificate is there. Bring it back, or "
                       "remove " +
                       certificate.string() + " to begin with a new key that players have to trust again.");
      }
      makeFile(key, makeKeyPem());  // if another process was faster, its key is loaded
    }
    const std::string key_pem = readKey(key);
    if (!fs::exists(certificate)) makeFile(certificate, makeCertificatePem(key_pem, now));
    ServerIdentity identity(readCertificate(certificate), key_pem);
    identity.warning_ = std::move(warning);
    return identity;
  });
}

ServerIdentity ServerIdentity::load(const fs::path& certificate, const fs::path& key) {
  return inWords([&] { return ServerIdentity(readCertificate(certificate), readKey(key)); });
}

ServerIdentity::ServerIdentity(const std::string& certificate_pem, const std::string& key_pem)
    : tls_(TlsContext::forServer(certificate_pem, key_pem)),
      fingerprint_(Fingerprint::of(*SSL_CTX_get0_certificate(tls_->get()))) {}

}  // namespace naiad
