#include "Samples.h"

#include "uav.idl.h"

#include <rabit/idl/GeneratedMessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <stdexcept>
#include <thread>

namespace
{

using Rabit::MessageTypeRegistry;
using testing::IsSupersetOf;

class Unknown : public Rabit::RabitMessage
{
public:
    std::unique_ptr<Rabit::RabitMessage> Clone() const override { return std::make_unique<Unknown>(*this); }
};

TEST(Registry, HoldsTheTypesOfAllLinkedIdlFiles)
{
    // Some of these types are not mentioned by any code in this program.
    EXPECT_THAT(MessageTypeRegistry::Names(),
                IsSupersetOf({"Basics::Stamp", "Constructs::Ground", "Global", "Keys::BaseKey",
                              "Marked::Track", "Uav::CommandAck", "Uav::TargetReport"}));
}

TEST(Registry, NamesAreSorted)
{
    const auto names = MessageTypeRegistry::Names();
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
}

TEST(Registry, NestedStructsAreNoTypesOfTheirOwn)
{
    EXPECT_EQ(MessageTypeRegistry::Find("Basics::Point"), nullptr);
}

TEST(Registry, FindsByName)
{
    EXPECT_EQ(MessageTypeRegistry::Find("Uav::Pose"), &Uav::Pose::IdlType());
    EXPECT_EQ(MessageTypeRegistry::Find("Uav::Nothing"), nullptr);
    EXPECT_EQ(MessageTypeRegistry::Find(""), nullptr);
}

TEST(Registry, FindsByMessage)
{
    EXPECT_EQ(MessageTypeRegistry::Of(Uav::Goto()), &Uav::Goto::IdlType());
    EXPECT_EQ(MessageTypeRegistry::Of(Unknown()), nullptr);
}

TEST(Registry, AddingTheSameTypeAgainIsNoError)
{
    EXPECT_NO_THROW(MessageTypeRegistry::Add(Uav::Pose::IdlType()));
    EXPECT_EQ(MessageTypeRegistry::Find("Uav::Pose"), &Uav::Pose::IdlType());
}

TEST(Registry, AddingAnotherTypeOfTheSameNameThrows)
{
    const Rabit::Idl::GeneratedMessageType<Uav::Goto> impostor("Uav::Pose", "struct Pose {};");
    EXPECT_THROW(MessageTypeRegistry::Add(impostor), std::logic_error);
    EXPECT_EQ(MessageTypeRegistry::Of(Uav::Goto()), &Uav::Goto::IdlType());
}

TEST(Registry, MayBeUsedFromSeveralThreads)
{
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
    {
        threads.emplace_back(
            []
            {
                for (int round = 0; round < 200; ++round)
                {
                    MessageTypeRegistry::Add(Uav::Pose::IdlType());
                    EXPECT_NE(MessageTypeRegistry::Find("Uav::Goto"), nullptr);
                    EXPECT_NE(MessageTypeRegistry::Of(Uav::Pose()), nullptr);
                    EXPECT_FALSE(MessageTypeRegistry::Names().empty());
                }
            });
    }
    for (std::thread &thread : threads)
    {
        thread.join();
    }
}

}  // namespace
