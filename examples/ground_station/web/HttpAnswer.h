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

// Answers GET and HEAD: a file of the table, or /pictures/<node>. Whatever stands in the URL is only compared
// with names, never made a path. Every answer carries the headers that keep a browser from running anything
// that is not a file of the page, from guessing types, and from showing the page inside another.
HttpResponse AnswerHttp(const HttpRequest &request, std::span<const PageFile> files,
                        const PictureStore &pictures, const RequestGuard &guard);

// An answer of one line of text.
HttpResponse RefuseHttp(boost::beast::http::status status, const std::string &reason, unsigned version,
                        bool keepAlive);

std::string_view HostOf(const HttpRequest &request);

// The tokens that a request shows: in the address of the page, in its cookie of that name, or as a bearer
// token. They live as long as the request.
std::vector<std::string_view> TokensOf(const HttpRequest &request, std::string_view cookie);
// Whether its address shows one.
bool HasTokenInTarget(const HttpRequest &request);
// Gives the browser the token as a cookie that no script can read and that no other site's page can use, and
// has it open the page under its plain address, so that the token stays in no history.
HttpResponse LetIn(const HttpRequest &request, std::string_view cookie, const std::string &token);
// To one that shows no token, or a wrong one.
HttpResponse AskForToken(const HttpRequest &request);

// What is wrong with a request to open a WebSocket; empty: nothing.
std::string RefusalOfUpgrade(const HttpRequest &request, const RequestGuard &guard);

}  // namespace Ground
