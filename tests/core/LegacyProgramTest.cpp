// A program in the style of earlier versions: flat includes, boost::bind, C++17. Compiled as C++17 and as
// C++20.
#include "PublishSubscribeMessage.h"

#include "RabitManager.h"
#include "RabitReactor.h"

#include <gtest/gtest.h>

#include <functional>

namespace
{

class PositionMessage : public Rabit::RabitMessage
{
public:
    double X = 0;
    double Y = 0;

    std::unique_ptr<Rabit::RabitMessage> Clone() const final
    {
        auto clone = std::make_unique<PositionMessage>();
        clone->CopyBase(this);
        clone->X = X;
        clone->Y = Y;
        return clone;
    }
    bool CopyMessage(Rabit::RabitMessage *msg) final
    {
        if (msg->GetTypeIndex() != std::type_index(typeid(PositionMessage)))
        {
            return false;
        }
        *this = *static_cast<PositionMessage *>(msg);
        return true;
    }
    void Clear() final { X = Y = 0; }
    std::string ToString() const final
    {
        std::ostringstream os;
        os << X << "," << Y;
        return os.str();
    }
};

class Navigator : public Rabit::RabitManager
{
public:
    Navigator() : RabitManager("Navigator")
    {
        _position_sptr = std::make_shared<PositionMessage>();
        AddPublishSubscribeMessage("Position", _position_sptr);
        _texts_sptr = std::make_shared<Rabit::RabitMessageQueue<std::string>>(10, "Texts");
        AddManagerMessageQueue("Texts", _texts_sptr);
        _numbers_sptr = std::make_shared<Rabit::RabitNonBlockingSPSCQueue<int>>(10, "Numbers");
        AddManagerMessageQueue("Numbers", _numbers_sptr);
        WakeUpManagerOnEnqueue(_texts_sptr);
        SetWakeupTimeDelayMSec(10);
        _position_sptr->Register_SomethingPublished(boost::bind(&Navigator::OnPost, this));
        _texts_sptr->Register_SomethingDequeued(std::bind(&Navigator::OnPost, this));
        boost::function<void()> function = [this]() { OnPost(); };
        _numbers_sptr->Register_SomethingEnqueued(function);
        std::function<void()> wakeUp = [this]() { WakeUpManagerEH(); };
        _mgrMessageQueue_sptr->Register_SomethingEnqueued(wakeUp);
        SetWakeupManagerUponMessagePostedToManagersMessageQueue();
    }
    void Startup() final { _mgrStatus_sptr->ManagerStats.Clear(); }
    void ExecuteUnitOfWork() final
    {
        _position_sptr->X += 1;
        _position_sptr->PostMessage();
        std::string text;
        while (_texts_sptr->GetMessage(text))
        {
            ++Texts;
        }
        std::shared_ptr<Rabit::RabitMessage> message;
        while (_mgrMessageQueue_sptr->GetMessage(message))
        {
            Last = message->ToString();
        }
        if (Texts > 0 && !Last.empty())
        {
            ShutdownAllManagers(true);
        }
    }
    void Shutdown() final {}
    void OnPost() { ++Handled; }

    std::atomic<int> Handled{0};
    int Texts = 0;
    std::string Last;

private:
    std::shared_ptr<PositionMessage> _position_sptr;
    std::shared_ptr<Rabit::RabitMessageQueue<std::string>> _texts_sptr;
    std::shared_ptr<Rabit::RabitNonBlockingSPSCQueue<int>> _numbers_sptr;
};

class Sender : public Rabit::RabitManager
{
public:
    explicit Sender(std::string name)
        : RabitManager(name), _position_sptr(std::make_shared<PositionMessage>())
    {
        AddPublishSubscribeMessage("Position", _position_sptr);
        WakeUpManagerOnMessagePost(_position_sptr);
    }
    void ExecuteUnitOfWork() final
    {
        if (_position_sptr->FetchMessage())
        {
            auto texts =
                GetManagerMessageQueue<std::shared_ptr<Rabit::RabitMessageQueue<std::string>>>("Texts");
            texts->AddMessage("hello");
            AddMessageToQueue("Texts", std::string("again"));
            std::shared_ptr<Rabit::RabitMessage> clone = _position_sptr->Clone();
            AddMessageToQueue("Navigator", clone);
        }
    }

private:
    std::shared_ptr<PositionMessage> _position_sptr;
};

TEST(LegacyProgram, RunsUnchanged)
{
    auto reactor = Rabit::RabitReactor();
    std::unique_ptr<Navigator> navigator(new Navigator());
    Navigator &nav = *navigator;
    reactor.AddManager(std::move(navigator));
    reactor.AddManager(std::unique_ptr<Sender>(new Sender("Sender")));
    reactor.Run();
    EXPECT_GE(nav.Texts, 1);
    EXPECT_GE(nav.Handled, 1);
    EXPECT_NE(nav.Last.find(",0"), std::string::npos);
}

TEST(LegacyProgram, HasTheSlotsOfBoostWithTheQueues)
{
    using Slot = boost::signals2::signal<void()>::slot_type;
    static_assert(std::is_same_v<Rabit::RabitMessageQueue<int>::_sigEnqueuSlotType, Slot>);
    static_assert(std::is_same_v<Rabit::RabitNonBlockingSPSCQueue<int>::_sigEnqueuSlotType, Slot>);
    int calls = 0;
    const Rabit::RabitMessageQueue<int>::_sigEnqueuSlotType slot([&calls] { ++calls; });
    Rabit::RabitMessageQueue<int> queue(1, "Numbers");
    queue.Register_SomethingEnqueued(slot.slot_function());
    queue.AddMessage(1);
    EXPECT_EQ(calls, 1);
}

TEST(LegacyProgram, SeesAllExceptionsWhicheverHeaderCameFirst)
{
    PositionMessage message;
    try
    {
        message.PostMessage();
        FAIL();
    }
    catch (const Rabit::GlobalPublishSubscribeException &)
    {
    }
    try
    {
        Rabit::RabitWorkspace::GetWorkspace()
            ->GetManagerMessageQueue<std::shared_ptr<Rabit::RabitMessageQueue<int>>>("no such queue");
        FAIL();
    }
    catch (const Rabit::MessageNotRegisteredException &)
    {
    }
}

}  // namespace
