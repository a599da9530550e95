#pragma once

#include "PageFiles.h"
#include "PictureStore.h"
#include "RequestGuard.h"

#include <boost/beast/http.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace Ground
{

using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;
using HttpResponse = boost::beast::http::response<boost::beast::http::string_body>;

// The target at which the page opens its WebSocket.
inline constexpr const char *LiveTarget = "/live";

// Answers GET and HEAD: a file of the table, or /pictures/<node>. The URL is only compared with names,
// never used as a path. The headers of every answer forbid the browser to run anything except the page's
// files, to guess types, and to show the page inside another.
HttpResponse AnswerHttp(const HttpRequest &request, std::span<const PageFile> files,
                        const PictureStore &pictures, const RequestGuard &guard);

// An answer of one line of text.
HttpResponse RefuseHttp(boost::beast::http::status status, const std::string &reason, unsigned version,
                        bool keepAlive);

std::string_view HostOf(const HttpRequest &request);

// The tokens in a request: in its address, in its cookie of that name, or as a bearer token. They live as
// long as the request.
std::vector<std::string_view> TokensOf(const HttpRequest &request, std::string_view cookie);
// True if the address of the request has a token.
bool HasTokenInTarget(const HttpRequest &request);
// Gives the browser the token as a cookie that no script can read and no other site's page can use. Then
// makes it open the page under its plain address, so that the token stays in no history. With TLS the browser
// shows the cookie by TLS alone.
HttpResponse LetIn(const HttpRequest &request, std::string_view cookie, const std::string &token,
                   bool hasTls);
// The answer to a request with no token or a wrong one.
HttpResponse AskForToken(const HttpRequest &request);

// The reason to refuse a request to open a WebSocket; empty if it is accepted.
std::string RefusalOfUpgrade(const HttpRequest &request, const RequestGuard &guard);

}  // namespace Ground
