#include "WebServer.h"

#include "../../Eventually.h"
#include "../../core/CapturedLog.h"
#include "PageClient.h"
#include "RawClient.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace
{
using namespace std::chrono_literals;
using boost::asio::ip::tcp;
using Ground::WebServer;
using GroundTest::PageClient;
using GroundTest::RawClient;
using RabitTest::Eventually;
using testing::HasSubstr;
using testing::Optional;
using testing::StartsWith;

const Ground::PageFile Files[] = {{"/", "text/html; charset=utf-8", "<p>page</p>"}};

std::shared_ptr<const std::string> Text(std::string text)
{
    return std::make_shared<const std::string>(std::move(text));
}

class WebServerTest : public testing::Test
{
protected:
    WebServer::Settings _settings;
    std::unique_ptr<WebServer> _server;

    void Start(WebServer::RequestHandler handler = [](const std::string &text) { return "reply to " + text; })
    {
        _server = std::make_unique<WebServer>(_settings, Files);
        _server->Start(std::move(handler));
    }
    tcp::endpoint Endpoint() const { return _server->Endpoint(); }
    std::string Answer(const std::string &request)
    {
        RawClient client(Endpoint());
        client.Send(request);
        return client.Rest();
    }
};

TEST_F(WebServerTest, ServesThePage)
{
    Start();
    const std::string answer = Answer("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK\r\n"));
    EXPECT_THAT(answer, HasSubstr("<p>page</p>"));
}

TEST_F(WebServerTest, SaysWhereItsPageIsAndWhatItMeansThatEverybodyMayOpenIt)
{
    EXPECT_THAT(WebServer(_settings, Files).Addresses(),
                testing::ElementsAre(StartsWith("Web page: http://127.0.0.1:"),
                                     StartsWith("Anybody who reaches this port commands the fleet")));
    _settings.Endpoint = {boost::asio::ip::address_v4::any(), 0};
    EXPECT_THAT(WebServer(_settings, Files).Addresses().back(),
                StartsWith("Anybody who reaches this port commands the fleet"));
}

TEST_F(WebServerTest, ServesSeveralRequestsOnOneConnection)
{
    Start();
    const std::string answer = Answer(
        "GET /nothing HTTP/1.1\r\nHost: localhost\r\n\r\nGET / HTTP/1.1\r\nHost: localhost\r\nConnection: "
        "close\r\n\r\n");
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 404 "));
    EXPECT_THAT(answer, HasSubstr("HTTP/1.1 200 OK\r\n"));
}

TEST_F(WebServerTest, RefusesWhatIsNoRequest)
{
    Start();
    for (const char *request :
         {"\r\nhello\r\n\r\n", "GET / HTTP/1.1\r\nHost localhost\r\n\r\n", "GET / HTTP/9.9\r\n\r\n",
          "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello"})
        EXPECT_THAT(Answer(request), StartsWith("HTTP/1.1 4")) << request;
}

TEST_F(WebServerTest, EndsAConnectionWhoseRequestIsTooLarge)
{
    Start();
    // The answer may be lost, because the connection is closed while more bytes come.
    EXPECT_THAT(Answer("GET /" + std::string(100'000, 'x') + " HTTP/1.1\r\n\r\n"),
                testing::Not(HasSubstr(" 200 ")));
    EXPECT_THAT(Answer("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(9000, 'x')),
                testing::Not(HasSubstr(" 200 ")));
}

TEST_F(WebServerTest, EndsAConnectionThatSaysNothing)
{
    _settings.RequestTime = 50ms;
    Start();
    EXPECT_EQ(Answer(""), "");
    EXPECT_EQ(Answer("GET / HTTP/1.1\r\n"), "");
}

TEST_F(WebServerTest, TakesSoManyConnectionsAndNoMore)
{
    _settings.Connections = {.Most = 3, .ForKnown = 0};
    Start();
    std::vector<std::unique_ptr<PageClient>> pages;
    for (int i = 0; i < 3; ++i)
    {
        pages.push_back(std::make_unique<PageClient>(Endpoint()));
        ASSERT_EQ(pages.back()->Open(), 101u);
    }
    EXPECT_EQ(PageClient(Endpoint()).Open(), 0u);
    EXPECT_EQ(_server->Count().ConnectionsRefused, 1u);
    pages.pop_back();
    EXPECT_TRUE(Eventually([this] { return PageClient(Endpoint()).Open() == 101u; }))
        << "a place became free";
}

TEST_F(WebServerTest, OpensThePageWhileAStrangerHoldsHundredsOfIdleConnections)
{
    _settings.RequestTime = std::chrono::minutes(10);  // waiting for them to end would take too long
    Start();
    PageClient before(Endpoint());
    ASSERT_EQ(before.Open(), 101u);
    std::vector<std::unique_ptr<RawClient>> idle;
    for (int i = 0; i < 300; ++i)
    {
        idle.push_back(std::make_unique<RawClient>(Endpoint()));
        if (i % 2 == 0)
            idle.back()->Send("GET / HTTP/1.1\r\n");  // and never goes on
    }
    EXPECT_THAT(Answer("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"),
                StartsWith("HTTP/1.1 200 OK\r\n"));
    EXPECT_EQ(PageClient(Endpoint()).Open(), 101u);
    EXPECT_GE(_server->Count().ConnectionsDropped, 270u);
    EXPECT_EQ(_server->Count().ConnectionsRefused, 0u);
    _server->Broadcast(Text("still here"));
    EXPECT_THAT(before.Next(), Optional(std::string("still here"))) << "an open page is not dropped";
}

TEST_F(WebServerTest, OpensAWebSocketForItsOwnPageOnly)
{
    Start();
    EXPECT_EQ(PageClient(Endpoint()).Open(), 101u);
    EXPECT_EQ(PageClient(Endpoint()).Open("http://evil.example"), 403u);
    EXPECT_EQ(PageClient(Endpoint()).Open("none"), 403u);
    EXPECT_EQ(PageClient(Endpoint()).Open({}, "evil.example"), 403u);
    EXPECT_EQ(PageClient(Endpoint()).Open({}, {}, "/elsewhere"), 403u);
}

TEST_F(WebServerTest, GivesANewPageTheLatestSnapshot)
{
    Start();
    _server->Broadcast(Text("one"));
    _server->Broadcast(Text("two"));
    PageClient page(Endpoint());
    ASSERT_EQ(page.Open(), 101u);
    // Both may have been distributed before the page came, or the last one after it.
    EXPECT_TRUE(Eventually([&] { return page.NextSeen() == "two"; }));
}

TEST_F(WebServerTest, GivesEveryPageEachSnapshotThatItCanFollow)
{
    Start();
    PageClient a(Endpoint());
    PageClient b(Endpoint());
    ASSERT_EQ(a.Open(), 101u);
    ASSERT_EQ(b.Open(), 101u);
    ASSERT_TRUE(Eventually([this] { return _server->Count().PagesOpen == 2; }));
    for (const char *text : {"1", "2", "3", "4", "5"})
    {
        _server->Broadcast(Text(text));
        EXPECT_THAT(a.NextSeen(), Optional(std::string(text)));
        EXPECT_THAT(b.NextSeen(), Optional(std::string(text)));
    }
    EXPECT_EQ(_server->Count().SnapshotsSkipped, 0u);
}

TEST_F(WebServerTest, SkipsSnapshotsForAPageThatDoesNotSayThatItHasSeenThem)
{
    Start();
    PageClient slow(Endpoint());
    PageClient quick(Endpoint());
    ASSERT_EQ(slow.Open(), 101u);
    ASSERT_EQ(quick.Open(), 101u);
    ASSERT_TRUE(Eventually([this] { return _server->Count().PagesOpen == 2; }));
    for (int i = 1; i <= 50; ++i)
    {
        _server->Broadcast(Text(std::to_string(i)));
        EXPECT_THAT(quick.NextSeen(), Optional(std::to_string(i))) << "a slow page holds no other one back";
    }
    EXPECT_EQ(_server->Count().SnapshotsSent, 52u);
    EXPECT_TRUE(Eventually([this] { return _server->Count().SnapshotsSkipped == 47; }))
        << "the quick page may be first";
    EXPECT_THAT(slow.Next(), Optional(std::string("1")));
    EXPECT_THAT(slow.NextSeen(), Optional(std::string("2")));
    EXPECT_THAT(slow.Next(), Optional(std::string("50"))) << "the next one is the latest";
}

TEST_F(WebServerTest, AnswersThePageThatAsks)
{
    Start();
    PageClient a(Endpoint());
    PageClient b(Endpoint());
    ASSERT_EQ(a.Open(), 101u);
    ASSERT_EQ(b.Open(), 101u);
    ASSERT_TRUE(a.Send("x"));
    EXPECT_THAT(a.Next(), Optional(std::string("reply to x")));
    ASSERT_TRUE(b.Send("y"));
    EXPECT_THAT(b.Next(), Optional(std::string("reply to y")));
}

TEST_F(WebServerTest, AnswersAPageThatHasNotSeenItsSnapshots)
{
    Start();
    PageClient page(Endpoint());
    ASSERT_EQ(page.Open(), 101u);
    ASSERT_TRUE(Eventually([this] { return _server->Count().PagesOpen == 1; }));
    _server->Broadcast(Text("1"));
    EXPECT_THAT(page.Next(), Optional(std::string("1")));
    _server->Broadcast(Text("2"));
    EXPECT_THAT(page.Next(), Optional(std::string("2")));
    _server->Broadcast(Text("3"));
    ASSERT_TRUE(page.Send("x"));
    EXPECT_THAT(page.Next(), Optional(std::string("reply to x")));
}

TEST_F(WebServerTest, DisconnectsAPageThatSendsTooMuchAtOnceOrNoText)
{
    Start();
    PageClient large(Endpoint());
    ASSERT_EQ(large.Open(), 101u);
    large.Send(std::string(WebServer::MaxMessageBytes + 1, 'x'));
    EXPECT_EQ(large.Next(), std::nullopt);
    PageClient binary(Endpoint());
    ASSERT_EQ(binary.Open(), 101u);
    binary.Send("x", false);
    EXPECT_EQ(binary.Next(), std::nullopt);
    EXPECT_TRUE(Eventually([this] { return _server->Count().PagesOpen == 0; }));
    EXPECT_EQ(PageClient(Endpoint()).Open(), 101u) << "it goes on";
}

TEST_F(WebServerTest, DisconnectsAPageThatAsksAndTakesNoAnswers)
{
    Start([](const std::string &) { return std::string(1'000'000, 'x'); });
    PageClient page(Endpoint());
    ASSERT_EQ(page.Open(), 101u);
    // The first answers wait in the buffers of the connection; then they wait at the server.
    EXPECT_TRUE(Eventually([&] { return !page.Send("x"); }));
    EXPECT_TRUE(Eventually([this] { return _server->Count().PagesOpen == 0; }));
}

TEST_F(WebServerTest, DisconnectsAPageThatFallsSilent)
{
    _settings.Silence = 100ms;
    Start();
    PageClient page(Endpoint());  // answers no ping, for it does not read
    ASSERT_EQ(page.Open(), 101u);
    ASSERT_TRUE(Eventually([this] { return _server->Count().PagesOpened == 1; }));
    EXPECT_TRUE(Eventually([this] { return _server->Count().PagesOpen == 0; }));
}

TEST_F(WebServerTest, GoesOnAfterARequestThatCouldNotBeHandled)
{
    const RabitTest::CapturedLog log;
    Start([](const std::string &) -> std::string { throw std::runtime_error("oops"); });
    PageClient page(Endpoint());
    ASSERT_EQ(page.Open(), 101u);
    page.Send("x");
    EXPECT_EQ(page.Next(), std::nullopt);
    EXPECT_THAT(log.Lines(), testing::ElementsAre(HasSubstr("oops")));
    EXPECT_EQ(PageClient(Endpoint()).Open(), 101u);
}

TEST_F(WebServerTest, SaysInOneLineThatAPortIsTaken)
{
    Start();
    _settings.Endpoint = Endpoint();
    try
    {
        const WebServer second(_settings, Files);
        FAIL() << "two servers on one port";
    }
    catch (const Ground::WebServerError &error)
    {
        EXPECT_EQ(error.what(), "The web page cannot be served at " + Ground::WebPageUrl(Endpoint()) +
                                    ": Address already in use");
    }
}

TEST_F(WebServerTest, StartsAgainOnTheSamePortWhereverItWasStopped)
{
    Start();
    PageClient page(Endpoint());
    ASSERT_EQ(page.Open(), 101u);
    RawClient half(Endpoint());
    half.Send("GET / HT");
    const tcp::endpoint before = Endpoint();
    _server->Stop();
    EXPECT_EQ(page.Next(), std::nullopt) << "it was disconnected";
    EXPECT_EQ(_server->Count().PagesOpen, 0u);
    _server->Broadcast(Text("for nobody"));
    _server->Start([](const std::string &) { return "second life"; });
    EXPECT_EQ(Endpoint(), before);
    PageClient again(Endpoint());
    ASSERT_EQ(again.Open(), 101u);
    ASSERT_TRUE(again.Send("x"));
    EXPECT_THAT(again.Next(), Optional(std::string("second life")));
}

TEST_F(WebServerTest, IsSafeToBroadcastWhilePagesComeAndGo)
{
    Start();
    std::atomic<bool> end{false};
    std::thread poster(
        [&]
        {
            for (int i = 0; !end; ++i)
            {
                _server->Broadcast(Text(std::to_string(i)));
                std::this_thread::yield();
            }
        });
    for (int i = 0; i < 20; ++i)
    {
        PageClient page(Endpoint());
        ASSERT_EQ(page.Open(), 101u);
        EXPECT_NE(page.NextSeen(), std::nullopt);
        EXPECT_NE(page.NextSeen(), std::nullopt);
    }
    _server->Stop();
    end = true;
    poster.join();
}

}  // namespace
