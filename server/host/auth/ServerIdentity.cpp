#include "host/auth/ServerIdentity.h"

#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <memory>
#include <system_error>
#include <utility>

#include "shared/net/base/SafeFile.h"
#include "shared/net/stream/TlsContext.h"

namespace naiad {

namespace {

using Bio = std::unique_ptr<BIO, decltype([](BIO* bio) { BIO_free(bio); })>;
using Certificate = std::unique_ptr<X509, decltype([](X509* x509) { X509_free(x509); })>;
using Key = std::unique_ptr<EVP_PKEY, decltype([](EVP_PKEY* key) { EVP_PKEY_free(key); })>;
using Number = std::unique_ptr<BIGNUM, decltype([](BIGNUM* number) { BN_free(number); })>;

constexpr int kSerialBits = 127;

std::string contentOf(const Bio& bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &data);
  return std::string(data, static_cast<std::size_t>(size));
}

bool setSerial(X509* certificate) {
  const Number serial(BN_new());
  return serial && BN_rand(serial.get(), kSerialBits, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1 &&
         BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(certificate)) != nullptr;
}

bool setTimes(X509* certificate, std::chrono::system_clock::time_point now) {
  const std::time_t begin = std::chrono::system_clock::to_time_t(now - std::chrono::hours(24));
  return ASN1_TIME_set(X509_getm_notBefore(certificate), begin) != nullptr &&
         ASN1_TIME_set_string_X509(X509_getm_notAfter(certificate), "99991231235959Z") == 1;
}

bool setNames(X509* certificate) {
  X509_NAME* const name = X509_get_subject_name(certificate);
  return X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, reinterpret_cast<const unsigned char*>("naiad"),
                                    -1, -1, 0) == 1 &&
         X509_set_issuer_name(certificate, name) == 1;
}

namespace fs = std::filesystem;

constexpr std::size_t kMaxPem = 65'536;  // maximum size of a key or certificate chain, in bytes

std::string readKey(const fs::path& path) {
  const auto pem = readTrusted(path, kMaxPem, Links::kFollowed);
  if (!pem) throw TlsError("There is no key file " + path.string() + ".");
  if (isOpenToOthers(path)) {
    throw TlsError("The key file " + path.string() + " can be read by other users. Run: chmod 600 " +
                   path.string());
  }
  return *pem;
}

std::string readCertificate(const fs::path& path) {
  const auto pem = readTrusted(path, kMaxPem, Links::kFollowed);
  if (!pem) throw TlsError("There is no certificate file " + path.string() + ".");
  return *pem;
}

/// Converts a system error to a TlsError with a sentence.
template <class Action>
auto inWords(Action action) {
  try {
    return action();
  } catch (const std::system_error& error) {
    throw TlsError(std::string("The server's key or certificate cannot be used: ") + error.what() + ".");
  }
}

/// Returns a warning if others can write to the key's folder, because they can replace the key; otherwise "".
/// Throws TlsError if every user can.
std::string checkDirectory(const fs::path& directory) {
  struct stat facts {};
  if (::stat(directory.c_str(), &facts) != 0) return {};  // the next access reports the reason
  const std::string cure = " Run: chmod go-w " + directory.string();
  if ((facts.st_mode & S_IWOTH) != 0) {
    throw TlsError("The folder " + directory.string() +
                   " has the server's key, but every user can write to it." + cure);
  }
  if ((facts.st_mode & S_IWGRP) != 0)
    return "the folder " + directory.string() + " has the server's key, but its group can write to it." +
           cure;
  if (facts.st_uid != ::geteuid() && facts.st_uid != 0)
    return "the folder " + directory.string() + " has the server's key, but belongs to another user.";
  return {};
}

void makeDirectory(const fs::path& directory) {
  if (fs::is_directory(directory)) return;
  fs::create_directories(directory);
  fs::permissions(directory, fs::perms::owner_all);
}

}  // namespace

std::string makeKeyPem() {
  const Key key(EVP_EC_gen("P-256"));
  const Bio bio(BIO_new(BIO_s_mem()));
  if (!key || !bio ||
      PEM_write_bio_PKCS8PrivateKey(bio.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1) {
    throw TlsError("Cannot create a key for the server.");
  }
  return contentOf(bio);
}

std::string makeCertificatePem(const std::string& key_pem, std::chrono::system_clock::time_point now) {
  const Bio in(BIO_new_mem_buf(key_pem.data(), static_cast<int>(key_pem.size())));
  const Key key(PEM_read_bio_PrivateKey(
      in.get(), nullptr, [](char*, int, int, void*) { return -1; }, nullptr));
  if (!key) throw TlsError("The private key is not in PEM form, or is protected by a password.");
  const Certificate certificate(X509_new());
  const Bio out(BIO_new(BIO_s_mem()));
  const bool good = certificate && out && X509_set_version(certificate.get(), X509_VERSION_3) == 1 &&
                    setSerial(certificate.get()) && setTimes(certificate.get(), now) &&
                    setNames(certificate.get()) && X509_set_pubkey(certificate.get(), key.get()) == 1 &&
                    X509_sign(certificate.get(), key.get(), EVP_sha256()) > 0 &&
                    PEM_write_bio_X509(out.get(), certificate.get()) == 1;
  if (!good) throw TlsError("Cannot create a certificate for the server.");
  return contentOf(out);
}

fs::path ServerIdentity::defaultDirectory() {
  if (const auto directory = userDirectory("XDG_CONFIG_HOME", ".config")) return *directory;
  throw TlsError("No folder for the server's key: set HOME or XDG_CONFIG_HOME, or --identity.");
}

ServerIdentity ServerIdentity::loadOrMake(const fs::path& directory,
                                          std::chrono::system_clock::time_point now) {
  return inWords([&] {
    makeDirectory(directory);
    std::string warning = checkDirectory(directory);
    const fs::path key = directory / "key.pem";
    const fs::path certificate = directory / "certificate.pem";
    // Checked before the key, because another process that starts now makes the certificate last.
    const bool had_certificate = fs::exists(certificate);
    if (!fs::exists(key)) {
      if (had_certificate) {
        throw TlsError("The key " + key.string() +
                       " is missing, but its certificate exists. Restore the key, or remove " +
                       certificate.string() + " to create a new key, which players must then trust again.");
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
