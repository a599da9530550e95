// One manager posts and sends, the other fetches and receives.
#include "RabitManager.h"
#include "RabitReactor.h"
#include "RabitVersion.h"

#include <iostream>
#include <string_view>

// CMake knows the version of the headers.
static_assert(std::string_view(RABIT_VERSION_STRING) == PACKAGE_VERSION);

class Count : public Rabit::RabitMessage
{
public:
    int Value = 0;

    std::unique_ptr<Rabit::RabitMessage> Clone() const override { return std::make_unique<Count>(*this); }
    bool CopyMessage(Rabit::RabitMessage *msg) override
    {
        const auto *other = dynamic_cast<const Count *>(msg);
        if (other == nullptr)
        {
            return false;
        }
        *this = *other;
        return true;
    }
};

constexpr int Messages = 100;

class Writer : public Rabit::RabitManager
{
public:
    Writer() : RabitManager("Writer")
    {
        AddPublishSubscribeMessage("Count", _count);
        SetWakeupTimeDelaySec(0.001);
    }
    void ExecuteUnitOfWork() final
    {
        if (_count->Value < Messages)
        {
            ++_count->Value;
            _count->PostMessage();
            AddMessageToQueue("Reader", std::shared_ptr<Rabit::RabitMessage>(_count->Clone()));
        }
    }

private:
    std::shared_ptr<Count> _count = std::make_shared<Count>();
};

class Reader : public Rabit::RabitManager
{
public:
    Reader() : RabitManager("Reader")
    {
        AddPublishSubscribeMessage("Count", _count);
        WakeUpManagerOnMessagePost(_count);
    }
    void ExecuteUnitOfWork() final
    {
        _count->FetchMessage();
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            ++_received;
        }
        if (_received == Messages && _count->Value == Messages)
        {
            std::cout << "received " << _received << ", last post " << _count->Value << std::endl;
            ShutdownAllManagers(true);
        }
    }

private:
    std::shared_ptr<Count> _count = std::make_shared<Count>();
    int _received = 0;
};

int main()
{
    Rabit::RabitReactor reactor;
    reactor.AddManager(std::make_unique<Writer>());
    reactor.AddManager(std::make_unique<Reader>());
    reactor.Run();
}
