// `KeyExchangeThread`: which stamps it takes, and when it tells that the exchanges have settled.
#include "common/KeyExchangeThread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "KeyExchangeMessage.h"

namespace
{

using Rabit::KeyExchangeOutbox;
using Rabit::KeyExchangeStamp;
using Rabit::KeyExchangeThread;
using Message = KeyExchangeMessage;
using Bytes = std::vector<std::uint8_t>;

class KeyExchangeThreadTest : public testing::Test
{
protected:
    static constexpr std::uint8_t Peer = 7;

    KeyExchangeThreadTest()
    {
        Keys.Start(
            [this](const int & /*route*/, Bytes &datagram)
            {
                const std::lock_guard lock(_mutex);
                _sent = datagram;
            });
    }
    ~KeyExchangeThreadTest() override { Keys.Stop(); }

    void Ask()
    {
        const Message message = Message().To(Peer).Handshake("Req", 1, Peer);
        ASSERT_TRUE(Keys.Put(message.Datagram, *Rabit::ReadKeyExchange(message.Datagram), 0));
    }
    // A message of Peer to `addressee` that echoes the stamp of the request. It says that the answer took the
    // least time that can be told.
    Bytes Answer(std::uint8_t addressee)
    {
        const std::lock_guard lock(_mutex);
        Bytes answer = Message().To(addressee).Handshake("Reply", 1, addressee).Datagram;
        std::fill_n(answer.begin() + Rabit::Rtps::PrefixAt, sizeof(Rabit::KeyExchange::Prefix), Peer);
        KeyExchangeStamp{.SentAt = 1, .Echo = KeyExchangeStamp::Of(_sent).value().SentAt - 1}.AppendTo(
            answer);
        return answer;
    }

    KeyExchangeThread<int> Keys{std::make_shared<Rabit::DiscoveryTurns>(), 1400};

private:
    std::mutex _mutex;
    Bytes _sent;
};

TEST_F(KeyExchangeThreadTest, AStampForThisNodeTellsTheAnswerTime)
{
    Ask();
    const Bytes answer = Answer(Message::Self);
    Keys.Came(answer);
    EXPECT_GT(Keys.AnswerTime(), KeyExchangeOutbox::Duration(0));
}

TEST_F(KeyExchangeThreadTest, AStampForAnotherNodeTellsNothing)
{
    Ask();
    const Bytes answer = Answer(Peer + 1);
    Keys.Came(answer);
    EXPECT_EQ(Keys.AnswerTime(), KeyExchangeOutbox::Duration(0));
}

TEST_F(KeyExchangeThreadTest, AStampAloneTellsNothing)
{
    Ask();
    const Bytes answer = Answer(Message::Self);
    Bytes stamp(answer.begin(), answer.begin() + Rabit::Rtps::RtpsHeaderSize);
    stamp.insert(stamp.end(), answer.end() - KeyExchangeStamp::Size, answer.end());
    Keys.Came(stamp);
    EXPECT_EQ(Keys.AnswerTime(), KeyExchangeOutbox::Duration(0));
}

TEST_F(KeyExchangeThreadTest, TellsThatExchangesHaveSettledAndThatOneHasBegun)
{
    std::mutex mutex;
    std::condition_variable changed;
    std::set<bool> told;
    const auto wait = [&](bool isSettled)
    {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return told.contains(isSettled); });
    };
    Keys.TellSettled(
        [&](bool isSettled)
        {
            const std::lock_guard lock(mutex);
            told.insert(isSettled);
            changed.notify_one();
        });
    wait(true);
    Ask();
    wait(false);
    Keys.Stop();
}

}  // namespace
