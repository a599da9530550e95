// Viewers over sockets of loopback.
#include "live/LiveServer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <nlohmann/json.hpp>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "FleetSession.h"

namespace Rabit::Tool
{
namespace
{

using nlohmann::json;
using testing::HasSubstr;
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;

LiveServer::Settings Anywhere()
{
    LiveServer::Settings settings;
    settings.Endpoint.port(0);
    settings.Silence = std::chrono::hours(1);  // a viewer may stall for as long as the machine likes
    return settings;
}

// A viewer. If a test is broken it waits for ever, and ctest ends it.
class Viewer
{
public:
    explicit Viewer(const LiveServer &server, const std::string &protocol = "foxglove.websocket.v1",
                    const std::string &origin = "", const std::string &target = "/")
        : _stream(_io)
    {
        // A small receive buffer, so that a viewer that does not read soon stalls.
        beast::get_lowest_layer(_stream).open(asio::ip::tcp::v4());
        beast::get_lowest_layer(_stream).set_option(asio::socket_base::receive_buffer_size(4096));
        beast::get_lowest_layer(_stream).connect(server.Endpoint());
        _stream.set_option(websocket::stream_base::decorator(
            [protocol, origin](websocket::request_type &request)
            {
                if (!protocol.empty())
                {
                    request.set(beast::http::field::sec_websocket_protocol, protocol);
                }
                if (!origin.empty())
                {
                    request.set(beast::http::field::origin, origin);
                }
            }));
        websocket::response_type answer;
        _stream.handshake(answer, "localhost", target, Error);
        Protocol = std::string(answer[beast::http::field::sec_websocket_protocol]);
    }

    void Send(const json &request)
    {
        _stream.text(true);
        _stream.write(asio::buffer(request.dump()));
    }
    void Subscribe(std::uint32_t id, std::uint32_t channel)
    {
        Send({{"op", "subscribe"}, {"subscriptions", json::array({{{"id", id}, {"channelId", channel}}})}});
    }
    struct Frame
    {
        std::optional<json> Text;
        std::string Value;  // its bytes, if it is no text
    };
    Frame Next()
    {
        beast::flat_buffer buffer;
        _stream.read(buffer);
        const std::string all = beast::buffers_to_string(buffer.data());
        return _stream.got_text() ? Frame{json::parse(all), ""}
                                  : Frame{std::nullopt, all.substr(LiveProtocol::MessageDataHeader)};
    }
    // Returns the next text of this operation.
    json Text(const std::string &op)
    {
        for (;;)
        {
            const Frame next = Next();
            if (next.Text && (*next.Text)["op"] == op)
            {
                return *next.Text;
            }
        }
    }
    // Returns the bytes of the next value.
    std::string Value()
    {
        for (;;)
        {
            const Frame next = Next();
            if (!next.Text)
            {
                return next.Value;
            }
        }
    }

    beast::error_code Error;
    std::string Protocol;

private:
    asio::io_context _io;
    websocket::stream<asio::ip::tcp::socket> _stream;
};

std::vector<std::uint8_t> Bytes(const std::string &text)
{
    return {text.begin(), text.end()};
}

LiveProtocol::Channel Named(const std::string &topic)
{
    LiveProtocol::Channel channel;
    channel.Topic = topic;
    return channel;
}

TEST(LiveServer, OffersWhatThereIsAndWhatComesLater)
{
    LiveServer server(Anywhere());
    server.AddChannel(Named("uav1/Pose"), false);
    Viewer viewer(server);
    EXPECT_EQ(viewer.Protocol, "foxglove.websocket.v1");
    EXPECT_EQ(viewer.Text("serverInfo")["name"], "rabit");
    EXPECT_EQ(viewer.Text("advertise")["channels"][0]["topic"], "uav1/Pose");
    server.AddChannel(Named("uav2/Pose"), false);
    EXPECT_EQ(viewer.Text("advertise")["channels"][0]["topic"], "uav2/Pose");
}

TEST(LiveServer, ShowsAViewerWhatItSubscribesTo)
{
    LiveServer server(Anywhere());
    const auto pose = server.AddChannel(Named("uav1/Pose"), false);
    const auto other = server.AddChannel(Named("uav1/Other"), true);
    server.Show(other, 1, Bytes("last"));
    Viewer viewer(server);
    viewer.Subscribe(5, pose);
    viewer.Subscribe(6, other);
    EXPECT_EQ(viewer.Value(), "last");  // so the subscriptions are known
    server.Show(pose, 2, Bytes("moved"));
    EXPECT_EQ(viewer.Value(), "moved");
}

TEST(LiveServer, AStateIsThereAtOnceAndWhatIsSaidOftenIsNot)
{
    LiveServer server(Anywhere());
    const auto pose = server.AddChannel(Named("uav1/Pose"), false);
    const auto state = server.AddChannel(Named("uav1/State"), true);
    server.Show(pose, 1, Bytes("old"));
    server.Show(state, 1, Bytes("replaced"));
    server.Show(state, 2, Bytes("last"));
    Viewer viewer(server);
    viewer.Subscribe(1, pose);
    viewer.Subscribe(2, state);
    EXPECT_EQ(viewer.Value(), "last");
}

TEST(LiveServer, WhatIsNotWantedAnyMoreDoesNotCome)
{
    LiveServer server(Anywhere());
    const auto first = server.AddChannel(Named("uav1/Pose"), true);
    const auto second = server.AddChannel(Named("uav2/Pose"), true);
    server.Show(second, 1, Bytes("here"));
    Viewer viewer(server);
    viewer.Subscribe(1, first);
    viewer.Send({{"op", "unsubscribe"}, {"subscriptionIds", {1}}});
    viewer.Subscribe(2, second);
    EXPECT_EQ(viewer.Value(), "here");
    server.Show(first, 2, Bytes("not wanted"));
    server.Show(second, 3, Bytes("wanted"));
    EXPECT_EQ(viewer.Value(), "wanted");
}

TEST(LiveServer, SaysWhatIsNotPossible)
{
    LiveServer server(Anywhere());
    Viewer viewer(server);
    viewer.Subscribe(1, 77);
    EXPECT_THAT(std::string(viewer.Text("status")["message"]), HasSubstr("channel 77 is not possible"));
    viewer.Send({{"op", "advertise"}, {"channels", json::array()}});
    EXPECT_THAT(std::string(viewer.Text("status")["message"]), HasSubstr("nothing can be sent"));
}

// The first viewer reads nothing, and the second everything.
TEST(LiveServer, AViewerThatStallsIsToldWhatItMissedAndDelaysNobody)
{
    constexpr std::size_t size = 100'000;
    constexpr int count = 300;
    LiveServer::Settings settings = Anywhere();
    settings.BytesOfViewer = 10 * size;
    LiveServer server(settings);
    const auto picture = server.AddChannel(Named("uav1/Picture"), true);
    server.Show(picture, 1, Bytes("first"));
    Viewer stalled(server);
    stalled.Subscribe(1, picture);
    EXPECT_EQ(stalled.Value(), "first");
    Viewer quick(server);
    quick.Subscribe(1, picture);
    EXPECT_EQ(quick.Value(), "first");
    for (int i = 0; i < count; ++i)
    {
        const std::string text = std::to_string(i);
        server.Show(picture, 2, Bytes(text + std::string(size - text.size(), ' ')));
        EXPECT_EQ(std::stoi(quick.Value()), i);
    }
    // The stalled viewer is told what it missed, and is shown the newest value.
    bool told = false;
    int shown = 0;
    while (!told || shown < count - 1)
    {
        const Viewer::Frame next = stalled.Next();
        told = told || (next.Text && std::string((*next.Text)["message"]).starts_with("uav1/Picture: "));
        shown = next.Text ? shown : std::stoi(next.Value);
    }
    EXPECT_GT(server.Count().Dropped, 100u);
}

TEST(LiveServer, RefusesWhoSpeaksAnotherProtocol)
{
    LiveServer server(Anywhere());
    EXPECT_TRUE(Viewer(server, "other").Error);
    EXPECT_TRUE(Viewer(server, "").Error);
}

TEST(LiveServer, SaysInABrowserThatItIsNoPage)
{
    LiveServer server(Anywhere());
    asio::io_context io;
    asio::ip::tcp::socket socket(io);
    socket.connect(server.Endpoint());
    beast::http::request<beast::http::empty_body> request(beast::http::verb::get, "/", 11);
    request.set(beast::http::field::host, "localhost");
    beast::http::write(socket, request);
    beast::flat_buffer buffer;
    beast::http::response<beast::http::string_body> answer;
    beast::http::read(socket, buffer, answer);
    EXPECT_EQ(answer.result(), beast::http::status::forbidden);
    EXPECT_THAT(answer.body(), HasSubstr("open it in Foxglove or Lichtblick"));
}

TEST(LiveServer, RefusesPagesOfOtherSites)
{
    LiveServer::Settings settings = Anywhere();
    settings.Origins = {"https://viewer.example.org"};
    LiveServer server(settings);
    EXPECT_TRUE(Viewer(server, "foxglove.websocket.v1", "https://evil.example.org").Error);
    EXPECT_TRUE(Viewer(server, "foxglove.websocket.v1", "http://localhost.evil.example.org").Error);
    EXPECT_FALSE(Viewer(server, "foxglove.websocket.v1", "https://viewer.example.org").Error);
    EXPECT_FALSE(Viewer(server, "foxglove.websocket.v1", "https://app.foxglove.dev").Error);
}

// A page that was saved on this machine, and one that another user of the machine serves.
TEST(LiveServer, RefusesPagesOfThisMachineUnlessTheUserNamesThem)
{
    LiveServer server(Anywhere());
    for (const char *origin :
         {"file://", "null", "http://localhost:8080", "http://127.0.0.1", "http://[::1]:80"})
    {
        EXPECT_TRUE(Viewer(server, "foxglove.websocket.v1", origin).Error) << origin;
    }
    LiveServer::Settings settings = Anywhere();
    settings.Origins = {"file://"};
    LiveServer named(settings);
    EXPECT_FALSE(Viewer(named, "foxglove.websocket.v1", "file://").Error);
    EXPECT_TRUE(Viewer(named, "foxglove.websocket.v1", "http://localhost:8080").Error);
}

// Other users of this machine reach loopback, too.
TEST(LiveServer, ShowsNothingToAViewerWithoutTheToken)
{
    LiveServer::Settings settings = Anywhere();
    settings.Token = "0123456789abcdef0123456789abcdef";
    LiveServer server(settings);
    const auto isRefused = [&](const std::string &target, const std::string &origin = "")
    { return Viewer(server, "foxglove.websocket.v1", origin, target).Error.failed(); };
    for (const std::string &target :
         {std::string("/"), std::string("/?token="), "/?token=" + settings.Token.substr(1),
          "/?token=" + settings.Token + "0", "/" + settings.Token, "/x?token=" + settings.Token})
    {
        EXPECT_TRUE(isRefused(target)) << target;
    }
    EXPECT_EQ(server.Count().Viewers, 0u);
    EXPECT_FALSE(isRefused("/?token=" + settings.Token));
    EXPECT_FALSE(isRefused("/?token=" + settings.Token, "https://app.foxglove.dev"));
    EXPECT_TRUE(isRefused("/?token=" + settings.Token, "https://evil.example.org"));
}

TEST(LiveServer, TakesSoManyViewersAndNoMore)
{
    LiveServer::Settings settings = Anywhere();
    settings.MostViewers = 1;
    LiveServer server(settings);
    Viewer first(server);
    EXPECT_FALSE(first.Error);
    first.Text("serverInfo");
    EXPECT_TRUE(Viewer(server).Error);
}

// The requests arrive together, so that handshakes overlap.
TEST(LiveServer, TakesNoMoreViewersIfSeveralComeAtOnce)
{
    constexpr std::size_t count = 20;
    LiveServer::Settings settings = Anywhere();
    settings.MostViewers = 1;
    LiveServer server(settings);
    asio::io_context io;
    std::vector<asio::ip::tcp::socket> sockets;
    for (std::size_t i = 0; i < count; ++i)
    {
        sockets.emplace_back(io).connect(server.Endpoint());
    }
    // Connections are accepted in order: the last one is answered when all wait for their requests.
    asio::write(sockets.back(), asio::buffer(std::string("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")));
    std::string answer(12, ' ');
    asio::read(sockets.back(), asio::buffer(answer));
    ASSERT_EQ(answer, "HTTP/1.1 403");
    sockets.pop_back();
    for (asio::ip::tcp::socket &socket : sockets)
    {
        asio::write(socket,
                    asio::buffer(std::string("GET / HTTP/1.1\r\n"
                                             "Host: localhost\r\n"
                                             "Upgrade: websocket\r\n"
                                             "Connection: Upgrade\r\n"
                                             "Sec-WebSocket-Version: 13\r\n"
                                             "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                                             "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n")));
    }
    std::size_t taken = 0;
    for (asio::ip::tcp::socket &socket : sockets)
    {
        asio::read(socket, asio::buffer(answer));
        taken += answer == "HTTP/1.1 101" ? 1 : 0;
    }
    EXPECT_EQ(taken, 1u);
}

TEST(LiveServer, ASeatIsFreeAgainWhenItsViewerLeaves)
{
    LiveServer::Settings settings = Anywhere();
    settings.MostViewers = 1;
    LiveServer server(settings);
    {
        Viewer first(server);
        EXPECT_FALSE(first.Error);
    }
    // The server has not read the end of the first connection yet.
    while (Viewer(server).Error)
    {
    }
}

TEST(LiveServer, APortThatIsTakenIsNamedAndIsNoFaultOfTheNetwork)
{
    LiveServer server(Anywhere());
    LiveServer::Settings settings;
    settings.Endpoint = server.Endpoint();
    try
    {
        LiveServer second(settings);
        FAIL() << "two servers have one port";
    }
    catch (const std::runtime_error &error)
    {
        EXPECT_EQ(dynamic_cast<const NetworkError *>(&error), nullptr);
        EXPECT_EQ(error.what(),
                  "viewers cannot be served at 127.0.0.1:" + std::to_string(server.Endpoint().port()) +
                      ": another program has that port; choose another one with --port");
    }
}

}  // namespace
}  // namespace Rabit::Tool
