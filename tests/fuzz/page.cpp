// Requests to the ground station's page, and those of viewers to `rabit foxglove`.
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "HttpAnswer.h"
#include "Input.h"
#include "PageRequest.h"
#include "PictureStore.h"
#include "live/LiveProtocol.h"

namespace
{

namespace http = boost::beast::http;

void ReadHttp(std::string_view text)
{
    http::request_parser<http::empty_body> parser;
    parser.header_limit(8192);
    boost::beast::error_code error;
    parser.put(boost::asio::buffer(text), error);
    if (!parser.is_header_done())
    {
        return;
    }
    const Ground::HttpRequest &request = parser.get();
    const Ground::RequestGuard guard(false, {"ground"});
    const Ground::PictureStore pictures;
    constexpr Ground::PageFile files[] = {{"/", "text/html", "page"}};
    Ground::HostOf(request);
    Ground::HasTokenInTarget(request);
    Ground::TokensOf(request, "rabit");
    Ground::RefusalOfUpgrade(request, guard);
    Ground::AnswerHttp(request, files, pictures, guard);
}

}  // namespace

// Byte 0: which of the three. The rest is the text.
int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    const unsigned choice = size == 0 ? 0 : data[0] % 3;
    const std::string_view text = Fuzz::TextOf(data, size).substr(std::min<std::size_t>(1, size));
    if (choice == 0)
    {
        ReadHttp(text);
    }
    else if (choice == 1)
    {
        const auto request = Ground::ParsePageRequest(std::string(text));
        Fuzz::Require(request.Refusal.empty() != std::holds_alternative<std::monostate>(request.Wish));
    }
    else
    {
        Rabit::Tool::LiveProtocol::ReadRequest(text);
        Rabit::Tool::LiveProtocol::ChosenOf(text);
    }
    return 0;
}
