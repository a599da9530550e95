#include "HttpAnswer.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace Ground
{
namespace
{
namespace http = boost::beast::http;

constexpr std::string_view PicturesTarget = "/pictures/";
constexpr std::string_view TokenTarget = "/?token=";
constexpr std::string_view Bearer = "Bearer ";

std::string_view ToView(boost::beast::string_view text)
{
    return {text.data(), text.size()};
}

void AddSecurityHeaders(HttpResponse &response)
{
    response.set("Content-Security-Policy",
                 "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
                 "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("X-Frame-Options", "DENY");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.set(http::field::cache_control, "no-store");
}

HttpResponse Make(http::status status, std::string_view type, std::string body, unsigned version,
                  bool keepAlive)
{
    HttpResponse response(status, version);
    AddSecurityHeaders(response);
    response.set(http::field::content_type, boost::beast::string_view(type.data(), type.size()));
    response.body() = std::move(body);
    response.keep_alive(keepAlive);
    response.prepare_payload();
    return response;
}

HttpResponse WithoutBody(HttpResponse response)
{
    const std::size_t size = response.body().size();
    response.body().clear();
    response.content_length(size);
    return response;
}

HttpResponse Find(const HttpRequest &request, std::span<const PageFile> files, const PictureStore &pictures)
{
    const unsigned version = request.version();
    const bool keepAlive = request.keep_alive();
    std::string_view target = ToView(request.target());
    target = target.substr(0, target.find('?'));
    const auto file =
        std::find_if(files.begin(), files.end(),
                     [target](const PageFile &candidate) { return candidate.Target == target; });
    if (file != files.end())
        return Make(http::status::ok, file->Type, std::string(file->Bytes), version, keepAlive);
    if (target.substr(0, PicturesTarget.size()) == PicturesTarget)
        if (const auto jpeg = pictures.Get(std::string(target.substr(PicturesTarget.size()))))
            return Make(http::status::ok, "image/jpeg", std::string(jpeg->begin(), jpeg->end()), version,
                        keepAlive);
    return RefuseHttp(http::status::not_found, "There is no such file.", version, keepAlive);
}
}  // namespace

HttpResponse RefuseHttp(http::status status, const std::string &reason, unsigned version, bool keepAlive)
{
    return Make(status, "text/plain; charset=utf-8", reason + "\n", version, keepAlive);
}

HttpResponse AnswerHttp(const HttpRequest &request, std::span<const PageFile> files,
                        const PictureStore &pictures, const RequestGuard &guard)
{
    if (!guard.IsHostAllowed(HostOf(request)))
        return RefuseHttp(http::status::forbidden, "This server does not go by that name.", request.version(),
                          false);
    if (request.method() != http::verb::get && request.method() != http::verb::head)
    {
        HttpResponse response = RefuseHttp(http::status::method_not_allowed,
                                           "Only GET and HEAD are answered.", request.version(), false);
        response.set(http::field::allow, "GET, HEAD");
        return response;
    }
    HttpResponse response = Find(request, files, pictures);
    return request.method() == http::verb::head ? WithoutBody(std::move(response)) : response;
}

std::string_view HostOf(const HttpRequest &request)
{
    return ToView(request[http::field::host]);
}

std::vector<std::string_view> TokensOf(const HttpRequest &request, std::string_view cookie)
{
    std::vector<std::string_view> tokens;
    if (HasTokenInTarget(request))
        tokens.push_back(ToView(request.target()).substr(TokenTarget.size()));
    std::string_view cookies = ToView(request[http::field::cookie]);
    while (!cookies.empty())
    {
        const std::size_t end = std::min(cookies.find(';'), cookies.size());
        std::string_view one = cookies.substr(0, end);
        one.remove_prefix(std::min(one.find_first_not_of(' '), one.size()));
        if (one.size() > cookie.size() && one.starts_with(cookie) && one[cookie.size()] == '=')
        {
            tokens.push_back(one.substr(cookie.size() + 1));
            break;
        }
        cookies.remove_prefix(std::min(end + 1, cookies.size()));
    }
    if (const std::string_view field = ToView(request[http::field::authorization]); field.starts_with(Bearer))
        tokens.push_back(field.substr(Bearer.size()));
    return tokens;
}

bool HasTokenInTarget(const HttpRequest &request)
{
    return ToView(request.target()).starts_with(TokenTarget);
}

HttpResponse LetIn(const HttpRequest &request, std::string_view cookie, const std::string &token, bool hasTls)
{
    // Not a redirection: after a link from another site the browser would not send the cookie with it.
    HttpResponse response =
        Make(http::status::ok, "text/html; charset=utf-8",
             "<!doctype html><meta http-equiv=\"refresh\" content=\"0; url=/\"><link rel=\"icon\" "
             "href=\"data:,\"><title>Ground station</title>"
             "<a href=\"/\">Open the page</a>\n",
             request.version(), request.keep_alive());
    response.set(http::field::set_cookie, std::string(cookie) + "=" + token + "; Path=/; " +
                                              (hasTls ? "Secure; " : "") + "HttpOnly; SameSite=Strict");
    return request.method() == http::verb::head ? WithoutBody(std::move(response)) : response;
}

HttpResponse AskForToken(const HttpRequest &request)
{
    HttpResponse response = RefuseHttp(
        http::status::unauthorized,
        "This page is for those who have its token: open the address that the ground station says when "
        "it starts.",
        request.version(), request.keep_alive());
    response.set(http::field::www_authenticate, "Bearer");
    return request.method() == http::verb::head ? WithoutBody(std::move(response)) : response;
}

std::string RefusalOfUpgrade(const HttpRequest &request, const RequestGuard &guard)
{
    const std::string_view host = HostOf(request);
    if (!guard.IsHostAllowed(host))
        return "This server does not go by that name.";
    if (!guard.IsOriginAllowed(ToView(request[http::field::origin]), host))
        return "Only the page of this server may connect.";
    if (ToView(request.target()) != LiveTarget)
        return "There is no such WebSocket.";
    return {};
}

}  // namespace Ground
