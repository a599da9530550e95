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
    if (!guard.IsHostAllowed(ToView(request[http::field::host])))
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

std::string RefusalOfUpgrade(const HttpRequest &request, const RequestGuard &guard)
{
    const std::string_view host = ToView(request[http::field::host]);
    if (!guard.IsHostAllowed(host))
        return "This server does not go by that name.";
    if (!RequestGuard::IsOriginAllowed(ToView(request[http::field::origin]), host))
        return "Only the page of this server may connect.";
    if (ToView(request.target()) != LiveTarget)
        return "There is no such WebSocket.";
    return {};
}

}  // namespace Ground
