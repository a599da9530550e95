#include "HttpAnswer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace
{
namespace http = boost::beast::http;
using testing::HasSubstr;

const Ground::PageFile AnsweredFiles[] = {{"/", "text/html; charset=utf-8", "<p>page</p>"},
                                          {"/a.js", "text/javascript; charset=utf-8", "let a;"}};

class HttpAnswer : public testing::Test
{
protected:
    Ground::PictureStore _pictures;
    Ground::RequestGuard _guard{true, {"field"}};

    static Ground::HttpRequest Request(http::verb method, const std::string &target)
    {
        Ground::HttpRequest request(method, target, 11);
        request.set(http::field::host, "127.0.0.1:8080");
        return request;
    }
    Ground::HttpResponse Answer(const Ground::HttpRequest &request)
    {
        return Ground::AnswerHttp(request, AnsweredFiles, _pictures, _guard);
    }
    Ground::HttpResponse Get(const std::string &target) { return Answer(Request(http::verb::get, target)); }
};

TEST_F(HttpAnswer, GivesTheFilesOfTheTable)
{
    const auto response = Get("/a.js?v=1");
    EXPECT_EQ(response.result(), http::status::ok);
    EXPECT_EQ(response[http::field::content_type], "text/javascript; charset=utf-8");
    EXPECT_EQ(response.body(), "let a;");
}

TEST_F(HttpAnswer, GivesNothingElse)
{
    for (const char *target : {"/b.js", "/../a.js", "/..%2f..%2fetc/passwd", "//a.js", "/a.js/", "", "a.js",
                               "/etc/passwd", "/pictures/", "/pictures/uav1", "/pictures/../a.js", "/live"})
        EXPECT_EQ(Get(target).result(), http::status::not_found) << target;
}

TEST_F(HttpAnswer, GivesTheLatestPictureOfAnAircraft)
{
    _pictures.Put("uav1", {0xFF, 0xD8, 0xFF, 7});
    const auto response = Get("/pictures/uav1?n=4");
    EXPECT_EQ(response.result(), http::status::ok);
    EXPECT_EQ(response[http::field::content_type], "image/jpeg");
    EXPECT_EQ(response.body(), "\xFF\xD8\xFF\x07");
}

TEST_F(HttpAnswer, AnswersHeadWithTheSizeAlone)
{
    const auto response = Answer(Request(http::verb::head, "/a.js"));
    EXPECT_EQ(response.result(), http::status::ok);
    EXPECT_EQ(response[http::field::content_length], "6");
    EXPECT_EQ(response.body(), "");
}

TEST_F(HttpAnswer, TakesNoOtherMethod)
{
    for (const auto method : {http::verb::post, http::verb::put, http::verb::delete_, http::verb::options})
    {
        const auto response = Answer(Request(method, "/"));
        EXPECT_EQ(response.result(), http::status::method_not_allowed);
        EXPECT_FALSE(response.keep_alive());
    }
}

TEST_F(HttpAnswer, GoesByNoForeignName)
{
    auto request = Request(http::verb::get, "/");
    request.set(http::field::host, "evil.example:8080");
    EXPECT_EQ(Answer(request).result(), http::status::forbidden);
    request.erase(http::field::host);
    EXPECT_EQ(Answer(request).result(), http::status::forbidden);
}

TEST_F(HttpAnswer, TellsTheBrowserToRunNothingButThePageWhateverTheAnswer)
{
    for (const char *target : {"/", "/nothing"})
    {
        const auto response = Get(target);
        const std::string policy(response["Content-Security-Policy"]);
        EXPECT_THAT(policy, HasSubstr("default-src 'none'"));
        EXPECT_THAT(policy, HasSubstr("script-src 'self';"));
        EXPECT_THAT(policy, HasSubstr("frame-ancestors 'none'"));
        EXPECT_THAT(policy, testing::Not(HasSubstr("unsafe")));
        EXPECT_EQ(response["X-Content-Type-Options"], "nosniff");
        EXPECT_EQ(response["X-Frame-Options"], "DENY");
    }
}

TEST_F(HttpAnswer, RefusesAnUpgradeOfAnotherOriginNameOrTarget)
{
    auto request = Request(http::verb::get, "/live");
    EXPECT_THAT(Ground::RefusalOfUpgrade(request, _guard), HasSubstr("Only the page"));
    request.set(http::field::origin, "http://evil.example");
    EXPECT_THAT(Ground::RefusalOfUpgrade(request, _guard), HasSubstr("Only the page"));
    request.set(http::field::origin, "http://127.0.0.1:8080");
    EXPECT_EQ(Ground::RefusalOfUpgrade(request, _guard), "");
    request.target("/other");
    EXPECT_THAT(Ground::RefusalOfUpgrade(request, _guard), HasSubstr("no such WebSocket"));
    // A request from a site that lets its own name point to this machine.
    request = Request(http::verb::get, "/live");
    request.set(http::field::host, "evil.example");
    request.set(http::field::origin, "http://evil.example");
    EXPECT_THAT(Ground::RefusalOfUpgrade(request, _guard), HasSubstr("not go by that name"));
}

TEST_F(HttpAnswer, FindsTheTokensThatARequestShows)
{
    auto request = Request(http::verb::get, "/?token=in-address");
    request.set(http::field::cookie,
                "a=b; __Host-rabit-8=other; __Host-rabit-80=in-cookie; __Host-rabit-80=again");
    request.set(http::field::authorization, "Bearer in-field");
    EXPECT_THAT(Ground::TokensOf(request, "__Host-rabit-80"),
                testing::ElementsAre("in-address", "in-cookie", "in-field"));
}

TEST_F(HttpAnswer, FindsNoTokenWhereNoneIsShown)
{
    EXPECT_THAT(Ground::TokensOf(Request(http::verb::get, "/"), "c"), testing::IsEmpty());
    for (const char *cookies : {"", ";", ";;;", "c", "cc=1", "=", " ; c ;", "xc=1"})
    {
        auto request = Request(http::verb::get, "/a.js?token=x");
        request.set(http::field::cookie, cookies);
        request.set(http::field::authorization, "Basic eDp5");
        EXPECT_THAT(Ground::TokensOf(request, "c"), testing::IsEmpty()) << cookies;
    }
}

TEST_F(HttpAnswer, GivesTheTokenAsACookieForThisSiteByTlsAndForNoScript)
{
    const auto response = Ground::LetIn(Request(http::verb::get, "/?token=t"), "__Host-rabit-80", "t", true);
    EXPECT_EQ(response.result(), http::status::ok);
    EXPECT_EQ(response[http::field::set_cookie],
              "__Host-rabit-80=t; Path=/; Secure; HttpOnly; SameSite=Strict");
    EXPECT_THAT(response.body(), HasSubstr("url=/"));
    EXPECT_THAT(response.body(), testing::Not(HasSubstr("token")));
}

TEST_F(HttpAnswer, GivesTheTokenWithoutTlsAsACookieThatABrowserTakesWithoutTls)
{
    const auto response = Ground::LetIn(Request(http::verb::get, "/?token=t"), "rabit-80", "t", false);
    EXPECT_EQ(response[http::field::set_cookie], "rabit-80=t; Path=/; HttpOnly; SameSite=Strict");
}

TEST_F(HttpAnswer, AsksForTheTokenAndTellsWhereItIs)
{
    const auto response = Ground::AskForToken(Request(http::verb::get, "/"));
    EXPECT_EQ(response.result(), http::status::unauthorized);
    EXPECT_THAT(response.body(), HasSubstr("open the address that the ground station says"));
    EXPECT_EQ(Ground::AskForToken(Request(http::verb::head, "/")).body(), "");
}

}  // namespace
