#pragma once

#include "PageFiles.h"
#include "PictureStore.h"
#include "RequestGuard.h"

#include <boost/beast/http.hpp>

#include <span>
#include <string>

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

// What is wrong with a request to open a WebSocket; empty: nothing.
std::string RefusalOfUpgrade(const HttpRequest &request, const RequestGuard &guard);

}  // namespace Ground
