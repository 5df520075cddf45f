#include "TestIdentity.h"

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <stdexcept>

namespace naiad::test {
namespace {

using Bio = std::unique_ptr<BIO, decltype([](BIO* bio) { BIO_free(bio); })>;
using Certificate = std::unique_ptr<X509, decltype([](X509* x509) { X509_free(x509); })>;
using Key = std::unique_ptr<EVP_PKEY, decltype([](EVP_PKEY* key) { EVP_PKEY_free(key); })>;

void check(bool good) {
  if (!good) throw std::runtime_error("OpenSSL could not make a test certificate");
}

std::string contentOf(const Bio& bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

void extend(X509* certificate, int what, const std::string& value) {
  X509_EXTENSION* const extension = X509V3_EXT_conf_nid(nullptr, nullptr, what, value.c_str());
  check(extension && X509_add_ext(certificate, extension, -1) == 1);
  X509_EXTENSION_free(extension);
}

}  // namespace

TestIdentity TestIdentity::make(const std::string& host, const TestIdentity* authority) {
  const Key key(EVP_EC_gen("P-256"));
  const Certificate certificate(X509_new());
  check(X509_set_version(certificate.get(), X509_VERSION_3) == 1);
  static long serial = 0;
  ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), ++serial);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -3600);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), 3600);
  X509_NAME* const name = X509_get_subject_name(certificate.get());
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, reinterpret_cast<const unsigned char*>(host.c_str()),
                             -1, -1, 0);
  X509_set_pubkey(certificate.get(), key.get());
  extend(certificate.get(), NID_subject_alt_name, "DNS:" + host);
  extend(certificate.get(), NID_basic_constraints, "critical,CA:TRUE");
  if (authority) {
    const Bio above(
        BIO_new_mem_buf(authority->certificate.data(), static_cast<int>(authority->certificate.size())));
    const Bio above_key(BIO_new_mem_buf(authority->key.data(), static_cast<int>(authority->key.size())));
    const Certificate issuer(PEM_read_bio_X509(above.get(), nullptr, nullptr, nullptr));
    const Key issuer_key(PEM_read_bio_PrivateKey(above_key.get(), nullptr, nullptr, nullptr));
    X509_set_issuer_name(certificate.get(), X509_get_subject_name(issuer.get()));
    check(X509_sign(certificate.get(), issuer_key.get(), EVP_sha256()) > 0);
  } else {
    X509_set_issuer_name(certificate.get(), name);
    check(X509_sign(certificate.get(), key.get(), EVP_sha256()) > 0);
  }
  const Bio certificate_out(BIO_new(BIO_s_mem()));
  const Bio key_out(BIO_new(BIO_s_mem()));
  check(PEM_write_bio_X509(certificate_out.get(), certificate.get()) == 1);
  check(PEM_write_bio_PKCS8PrivateKey(key_out.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1);
  return {contentOf(certificate_out), contentOf(key_out)};
}

const TestIdentity& testIdentity() {
  static const TestIdentity identity = TestIdentity::make("naiad.test");
  return identity;
}

std::shared_ptr<const TlsContext> testServerContext() {
  static const auto context = TlsContext::forServer(testIdentity().certificate, testIdentity().key);
  return context;
}

std::shared_ptr<const TlsContext> testClientContext() {
  static const auto context = TlsContext::forClient();
  return context;
}

}  // namespace naiad::test
