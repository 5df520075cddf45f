// The gateway's responses to HTTP requests. A response depends only on the request, the page and the
// settings.
//
// HTTP/1.1 (RFC 9110, 9112). Every response has the headers that keep a browser from running foreign scripts,
// and from framing or leaking the page.
#pragma once

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/gateway/AllowedOrigins.h"
#include "server/gateway/PageFiles.h"
#include "shared/net/base/WebSocketProtocol.h"

namespace naiad {

using WebRequest = boost::beast::http::request<boost::beast::http::empty_body>;

struct HttpResponse {
  std::string head;              ///< status line, headers and the empty line after them
  std::string text;              ///< body of a generated response
  std::string_view content;      ///< body of a file, owned by PageFiles
  bool keeps_connection = true;  ///< another request may follow on the connection
  bool is_refusal = false;       ///< status 400 or above

  std::string_view body() const { return text.empty() ? content : std::string_view(text); }
};

/// Makes the responses of a gateway. Immutable.
class HttpResponses {
 public:
  /// `server_json`: response to GET /server. `page` and `origins` must outlive this.
  HttpResponses(const PageFiles& page, const AllowedOrigins& origins, std::string server_json, bool has_tls);

  /// Returns the response to a request that is not a WebSocket upgrade.
  HttpResponse response(const WebRequest& request) const;
  /// Returns an error response with a message; the connection ends after the response.
  HttpResponse refusal(int status, std::string_view message) const;
  /// The status and message of a refused request.
  struct Refusal {
    int status;
    std::string_view message;
  };
  /// Returns null if the request may become a WebSocket, else the refusal: 505 for another version of HTTP,
  /// 421 for a wrong Host, 404 for a wrong path, 403 for an Origin that is missing, repeated or not allowed,
  /// 400 without the subprotocol.
  const Refusal* validateUpgrade(const WebRequest& request) const;

  using Header = std::pair<std::string_view, std::string_view>;
  /// Returns the headers that every response has.
  const std::vector<Header>& commonHeaders() const { return m_common; }
  /// Returns the path of a request, without its query.
  static std::string_view pathOf(const WebRequest& request);

 private:
  /// Like validateUpgrade(), but checks only what every request needs: HTTP version and Host.
  const Refusal* validateHost(const WebRequest& request) const;
  HttpResponse fileResponse(const WebRequest& request, const PageFile& file) const;
  HttpResponse make(const WebRequest& request, int status, std::string_view headers,
                    std::string_view body) const;

  const PageFiles& m_page;
  const AllowedOrigins& m_origins;
  std::string m_server_json;
  std::vector<Header> m_common;
  std::string m_common_text;
};

}  // namespace naiad
