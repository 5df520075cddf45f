#include "shared/net/stream/TlsContext.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>

#include <algorithm>
#include <span>

namespace naiad {
namespace {

constexpr std::size_t kMaxCertificates = 32'768;  // maximum bytes of a server's chain
constexpr int kMaxChain = 10;                     // maximum number of certificates above the server's own

using Bio = std::unique_ptr<BIO, decltype([](BIO* bio) { BIO_free(bio); })>;
using Certificate = std::unique_ptr<X509, decltype([](X509* x509) { X509_free(x509); })>;
using Key = std::unique_ptr<EVP_PKEY, decltype([](EVP_PKEY* key) { EVP_PKEY_free(key); })>;

/// Called before a hello is answered. The first call for a stream stops the handshake (TlsStream::handshake).
/// A hello without the ALPN extension fails here, because OpenSSL would not call chooseAlpn().
int judgeHello(SSL* ssl, int* alert, void*) {
  if (bool* const p_judged = static_cast<bool*>(SSL_get_app_data(ssl)); p_judged && !*p_judged) {
    *p_judged = true;
    return SSL_CLIENT_HELLO_RETRY;
  }
  const unsigned char* data = nullptr;
  std::size_t size = 0;
  if (SSL_client_hello_get0_ext(ssl, TLSEXT_TYPE_application_layer_protocol_negotiation, &data, &size) == 1) {
    return SSL_CLIENT_HELLO_SUCCESS;
  }
  *alert = SSL_AD_NO_APPLICATION_PROTOCOL;
  return SSL_CLIENT_HELLO_ERROR;
}

int chooseAlpn(SSL*, const unsigned char** out, unsigned char* out_size, const unsigned char* in,
               unsigned int in_size, void* protocol) {
  const std::string_view wanted = *static_cast<const std::string_view*>(protocol);
  std::span<const unsigned char> offers(in, in_size);
  while (!offers.empty() && offers[0] < offers.size()) {
    const auto offer = offers.subspan(1, offers[0]);
    if (std::ranges::equal(offer, wanted,
                           [](unsigned char a, char b) { return a == static_cast<unsigned char>(b); })) {
      *out = offer.data();
      *out_size = static_cast<unsigned char>(offer.size());
      return SSL_TLSEXT_ERR_OK;
    }
    offers = offers.subspan(1 + offer.size());
  }
  return SSL_TLSEXT_ERR_ALERT_FATAL;
}

/// Replaces OpenSSL's callback, which would ask for a password at the terminal.
int noPassword(char*, int, int, void*) {
  return -1;
}

}  // namespace

void TlsContext::Free::operator()(ssl_ctx_st* context) const {
  SSL_CTX_free(context);
}

TlsContext::TlsContext(bool is_server)
    : context_(SSL_CTX_new(is_server ? TLS_server_method() : TLS_client_method())), is_server_(is_server) {
  SSL_CTX* const c = context_.get();
  ERR_clear_error();
  const bool good = c && SSL_CTX_set_min_proto_version(c, TLS1_3_VERSION) == 1 &&
                    SSL_CTX_set_max_proto_version(c, TLS1_3_VERSION) == 1 &&
                    SSL_CTX_set_ciphersuites(c,
                                             "TLS_AES_128_GCM_SHA256:TLS_CHACHA20_POLY1305_SHA256:"
                                             "TLS_AES_256_GCM_SHA384") == 1 &&
                    SSL_CTX_set1_groups_list(c, "X25519:P-256") == 1 && SSL_CTX_set_num_tickets(c, 0) == 1;
  if (!good)
    throw TlsError("This machine's OpenSSL does not offer TLS 1.3 with the ciphers that Naiad needs.");
  SSL_CTX_set_options(c, SSL_OP_NO_TICKET | SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
  SSL_CTX_set_session_cache_mode(c, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_max_early_data(c, 0);
  SSL_CTX_set_recv_max_early_data(c, 0);
  SSL_CTX_set_read_ahead(c, 0);
  SSL_CTX_set_max_cert_list(c, kMaxCertificates);
  SSL_CTX_set_verify(c, SSL_VERIFY_NONE, nullptr);
  SSL_CTX_set_mode(
      c, SSL_MODE_RELEASE_BUFFERS | SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  SSL_CTX_clear_mode(c, SSL_MODE_AUTO_RETRY);  // records without data must not keep read() busy
}

std::shared_ptr<const TlsContext> TlsContext::forServer(const std::string& certificate_pem,
                                                        const std::string& key_pem) {
  std::shared_ptr<TlsContext> made(new TlsContext(true));
  made->useCertificate(certificate_pem);
  made->useKey(key_pem);
  SSL_CTX_set_client_hello_cb(made->get(), judgeHello, nullptr);
  made->choose(kAlpn);
  return made;
}

std::shared_ptr<const TlsContext> TlsContext::forWebServer(const std::string& certificate_pem,
                                                           const std::string& key_pem) {
  std::shared_ptr<TlsContext> made(new TlsContext(true));
  made->useCertificate(certificate_pem);
  made->useKey(key_pem);
  made->required_alpn_ = {};
  made->choose(kHttpAlpn);
  return made;
}

/// `protocol`: a global constant, because OpenSSL stores its address.
void TlsContext::choose(const std::string_view& protocol) {
  SSL_CTX_set_alpn_select_cb(get(), chooseAlpn, const_cast<std::string_view*>(&protocol));
}

/// Offers one ALPN name, preceded by its length as on the wire.
void TlsContext::offer(std::string_view protocol) {
  const std::string alpn = static_cast<char>(protocol.size()) + std::string(protocol);
  if (SSL_CTX_set_alpn_protos(get(), reinterpret_cast<const unsigned char*>(alpn.data()),
                              static_cast<unsigned int>(alpn.size())) != 0) {
    throw TlsError("OpenSSL refused the name of the protocol.");
  }
}

std::shared_ptr<const TlsContext> TlsContext::forWebClient() {
  std::shared_ptr<TlsContext> made(new TlsContext(false));
  made->required_alpn_ = {};
  made->offer(kHttpAlpn);
  SSL_CTX* const c = made->get();
  if (SSL_CTX_set_min_proto_version(c, TLS1_2_VERSION) != 1 ||
      SSL_CTX_set1_groups_list(c, "X25519:P-256:P-384:P-521") != 1)
    throw TlsError("This machine's OpenSSL does not offer TLS 1.2 with X25519 or P-256 to P-521.");
  SSL_CTX_set_verify(c, SSL_VERIFY_PEER, nullptr);
  SSL_CTX_set_default_verify_paths(c);  // without a trust store, no chain verifies
  ERR_clear_error();
  return made;
}

std::shared_ptr<const TlsContext> TlsContext::forClient(const std::string& trust_file) {
  std::shared_ptr<TlsContext> made(new TlsContext(false));
  made->offer(kAlpn);
  if (trust_file.empty()) {
    SSL_CTX_set_default_verify_paths(made->get());  // without a store, no chain verifies and keys are pinned
  } else if (SSL_CTX_load_verify_file(made->get(), trust_file.c_str()) != 1) {
    throw TlsError("The trusted certificates in " + trust_file + " cannot be read.");
  }
  ERR_clear_error();
  return made;
}

void TlsContext::useCertificate(const std::string& pem) {
  const Bio bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  const Certificate own(PEM_read_bio_X509(bio.get(), nullptr, noPassword, nullptr));
  if (!own) throw TlsError("The certificate is not in PEM form.");
  if (SSL_CTX_use_certificate(get(), own.get()) != 1) throw TlsError("OpenSSL refuses the certificate.");
  for (int count = 0;; ++count) {
    const Certificate above(PEM_read_bio_X509(bio.get(), nullptr, noPassword, nullptr));
    if (!above) break;
    if (count == kMaxChain || SSL_CTX_add1_chain_cert(get(), above.get()) != 1) {
      throw TlsError("OpenSSL refuses the chain of certificates.");
    }
  }
  // PEM_R_NO_START_LINE is no error: the file ends, or other text follows the chain.
  if (ERR_GET_REASON(ERR_peek_last_error()) != PEM_R_NO_START_LINE) {
    throw TlsError("The chain of certificates is damaged.");
  }
  ERR_clear_error();
}

void TlsContext::useKey(const std::string& pem) {
  const Bio bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  const Key key(PEM_read_bio_PrivateKey(bio.get(), nullptr, noPassword, nullptr));
  if (!key) throw TlsError("The private key is not in PEM form, or is protected by a password.");
  const bool fits = SSL_CTX_use_PrivateKey(get(), key.get()) == 1 && SSL_CTX_check_private_key(get()) == 1;
  ERR_clear_error();
  if (!fits) throw TlsError("The certificate does not match the private key.");
}

}  // namespace naiad
