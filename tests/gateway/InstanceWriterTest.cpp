// A message whose key changes: the samples and disposals written, and their order, on a network that does
// not take everything.
#include "mirrors/InstanceWriter.h"

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <vector>

#include "keyed.idl.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

using testing::ElementsAre;

struct Network
{
    WriteResult Writes = WriteResult::Ok;
    WriteResult Disposals = WriteResult::Ok;
    std::vector<std::string> Taken;
    int Tried = 0;
};

class Writer final : public TransportWriter
{
public:
    explicit Writer(Network &network) : _network(network) {}
    WriteResult Write(const SampleEncoder &sample, std::int64_t time) override
    {
        return Take("write ", sample, time, _network.Writes);
    }
    WriteResult WriteTo(const std::string &, const SampleEncoder &, std::int64_t) override
    {
        return WriteResult::Failed;
    }
    WriteResult Dispose(const SampleEncoder &sample, std::int64_t time) override
    {
        return Take("dispose ", sample, time, _network.Disposals);
    }
    int MatchedReaders() const override { return 3; }

private:
    WriteResult Take(const char *what, const SampleEncoder &sample, std::int64_t time, WriteResult result)
    {
        ++_network.Tried;
        std::vector<std::uint8_t> bytes(sample.EncodedSize());
        GatewayTest::Contact contact;
        if (!sample.Encode(bytes))
        {
            return WriteResult::Failed;
        }
        if (result == WriteResult::Ok)
        {
            GatewayTest::Contact::IdlType().Deserialize(bytes, contact);
            _network.Taken.push_back(what + std::to_string(contact.number) + " at " + std::to_string(time));
        }
        return result;
    }

    Network &_network;
};

class InstanceWriterTest : public testing::Test
{
protected:
    WriteResult Write(std::uint32_t number, std::int64_t time)
    {
        GatewayTest::Contact contact;
        contact.number = number;
        contact.text = "at " + std::to_string(time);
        return writer.Write(contact, time);
    }

    Network network;
    InstanceWriter writer{GatewayTest::Contact::IdlType(), std::make_unique<Writer>(network)};
};

TEST_F(InstanceWriterTest, TheNewInstanceIsWrittenBeforeTheFormerIsDisposed)
{
    EXPECT_EQ(Write(1, 10), WriteResult::Ok);
    EXPECT_EQ(Write(2, 20), WriteResult::Ok);
    EXPECT_EQ(Write(3, 30), WriteResult::Ok);
    EXPECT_EQ(Write(1, 40), WriteResult::Ok);
    EXPECT_THAT(network.Taken,
                ElementsAre("write 1 at 10", "write 2 at 20", "dispose 1 at 20", "write 3 at 30",
                            "dispose 2 at 30", "write 1 at 40", "dispose 3 at 40"));
    EXPECT_FALSE(writer.OwesDisposal());
}

TEST_F(InstanceWriterTest, ValuesOfOneKeyAreWrittenAndNothingElse)
{
    Write(7, 10);
    Write(7, 20);
    Write(7, 30);
    EXPECT_THAT(network.Taken, ElementsAre("write 7 at 10", "write 7 at 20", "write 7 at 30"));
}

TEST_F(InstanceWriterTest, TheKeyZeroIsAKeyAsAllOthers)
{
    Write(0, 10);
    Write(1, 20);
    Write(0, 30);
    EXPECT_THAT(network.Taken, ElementsAre("write 0 at 10", "write 1 at 20", "dispose 0 at 20",
                                           "write 0 at 30", "dispose 1 at 30"));
}

TEST_F(InstanceWriterTest, AValueThatWasNotWrittenDisposesNothing)
{
    Write(1, 10);
    for (const WriteResult failure : {WriteResult::TimedOut, WriteResult::Failed, WriteResult::TooLarge})
    {
        network.Writes = failure;
        EXPECT_EQ(Write(2, 20), failure);
        EXPECT_FALSE(writer.OwesDisposal());
    }
    network.Writes = WriteResult::Ok;
    Write(3, 30);
    EXPECT_THAT(network.Taken, ElementsAre("write 1 at 10", "write 3 at 30", "dispose 1 at 30"));
}

TEST_F(InstanceWriterTest, AFirstValueThatWasNotWrittenHasNoInstance)
{
    network.Writes = WriteResult::TimedOut;
    Write(1, 10);
    network.Writes = WriteResult::Ok;
    Write(2, 20);
    EXPECT_THAT(network.Taken, ElementsAre("write 2 at 20"));
}

TEST_F(InstanceWriterTest, ADisposalThatIsOwedComesBeforeTheNextValue)
{
    Write(1, 10);
    network.Disposals = WriteResult::TimedOut;
    EXPECT_EQ(Write(2, 20), WriteResult::Ok) << "the value is there";
    EXPECT_TRUE(writer.OwesDisposal());
    EXPECT_EQ(writer.DisposeFormer(), WriteResult::TimedOut);
    EXPECT_EQ(Write(3, 30), WriteResult::TimedOut);
    EXPECT_THAT(network.Taken, ElementsAre("write 1 at 10", "write 2 at 20"));
    network.Disposals = WriteResult::Ok;
    EXPECT_EQ(Write(1, 40), WriteResult::Ok);
    EXPECT_FALSE(writer.OwesDisposal());
    EXPECT_THAT(network.Taken, ElementsAre("write 1 at 10", "write 2 at 20", "dispose 1 at 20",
                                           "write 1 at 40", "dispose 2 at 40"));
}

TEST_F(InstanceWriterTest, ADisposalThatIsOwedCanBeMadeWithoutAValue)
{
    Write(1, 10);
    network.Disposals = WriteResult::TimedOut;
    Write(2, 20);
    network.Disposals = WriteResult::Ok;
    EXPECT_EQ(writer.DisposeFormer(), WriteResult::Ok);
    EXPECT_FALSE(writer.OwesDisposal());
    EXPECT_EQ(writer.DisposeFormer(), WriteResult::Ok);
    EXPECT_THAT(network.Taken, ElementsAre("write 1 at 10", "write 2 at 20", "dispose 1 at 20"));
}

TEST_F(InstanceWriterTest, ADisposalThatFailsForGoodIsNotTriedAgain)
{
    Write(1, 10);
    network.Disposals = WriteResult::Failed;
    EXPECT_EQ(Write(2, 20), WriteResult::Ok);
    EXPECT_FALSE(writer.OwesDisposal());
    EXPECT_EQ(network.Tried, 3);
}

TEST(InstanceWriter, WithoutAKeyNothingIsDisposed)
{
    Network network;
    InstanceWriter writer(Uav::Pose::IdlType(), std::make_unique<Writer>(network));
    Uav::Pose pose;
    for (std::uint32_t number = 1; number <= 3; ++number)
    {
        pose.number = number;
        EXPECT_EQ(writer.Write(pose, 1), WriteResult::Ok);
    }
    EXPECT_EQ(network.Tried, 3);
    EXPECT_EQ(writer.MatchedReaders(), 3);
}

}  // namespace
}  // namespace Rabit
