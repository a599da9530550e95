#include "common/PeerResolver.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

namespace
{

using namespace Rabit;

// Only keeps a broken resolver from waiting for ever.
constexpr std::chrono::minutes Long{10};

TEST(PeerResolver, KnowsAtOnceWhatIsKnownAtOnce)
{
    const PeerResolver resolver(
        {"ground"}, [](const std::string &) { return std::optional<std::string>("10.0.0.9"); }, Long);
    EXPECT_EQ(resolver.AddressOf("ground"), "10.0.0.9");
    EXPECT_EQ(resolver.AddressOf("another"), std::nullopt);
}

TEST(PeerResolver, WaitsForFirstAnswersThatTakeAMoment)
{
    const PeerResolver resolver(
        {"ground", "uav2"},
        [](const std::string &) -> std::optional<std::string>
        {
            for (int i = 0; i < 1000; ++i)
            {
                std::this_thread::yield();
            }
            return "10.0.0.9";
        },
        Long);
    EXPECT_EQ(resolver.AddressOf("uav2"), "10.0.0.9");
}

TEST(PeerResolver, LooksAgainForWhatHasNoAddress)
{
    const auto asked = std::make_shared<std::atomic<int>>(0);
    const PeerResolver resolver({"ground"},
                                [asked](const std::string &) -> std::optional<std::string>
                                {
                                    if (++*asked < 3)
                                    {
                                        return std::nullopt;
                                    }
                                    return "10.0.0.9";
                                });
    while (resolver.AddressOf("ground") != "10.0.0.9")
    {
        std::this_thread::yield();
    }
    EXPECT_EQ(*asked, 3);
}

TEST(PeerResolver, LooksNoMoreForWhatHasAnAddress)
{
    const auto asked = std::make_shared<std::atomic<int>>(0);
    const auto others = std::make_shared<std::atomic<int>>(0);
    const PeerResolver resolver({"ground", "uav2"},
                                [asked, others](const std::string &host) -> std::optional<std::string>
                                {
                                    if (host == "ground")
                                    {
                                        return "10.0.0." + std::to_string(++*asked);
                                    }
                                    return ++*others < 3 ? std::nullopt
                                                         : std::optional<std::string>("10.0.0.9");
                                });
    while (!resolver.AddressOf("uav2"))
    {
        std::this_thread::yield();
    }
    EXPECT_EQ(resolver.AddressOf("ground"), "10.0.0.1");
    EXPECT_EQ(*asked, 1);
}

TEST(PeerResolver, DoesNotWaitForALookupThatHangs)
{
    const auto hangs = std::make_shared<std::atomic<bool>>(true);
    {
        const PeerResolver resolver({"ground"},
                                    [hangs](const std::string &) -> std::optional<std::string>
                                    {
                                        hangs->wait(true);
                                        return std::nullopt;
                                    });
        EXPECT_EQ(resolver.AddressOf("ground"), std::nullopt);
    }
    *hangs = false;
    hangs->notify_all();
}

TEST(PeerResolver, TheSystemKnowsThisHost)
{
    EXPECT_EQ(PeerResolver::LookUpHost("localhost"), "127.0.0.1");
    EXPECT_EQ(PeerResolver::LookUpHost("no-such-host.invalid"), std::nullopt);
}

}  // namespace
