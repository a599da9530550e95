// The first tutorial: one manager that says hello once a second, until Ctrl-C or for the given number of
// times.
#include <rabit/RabitReactor.h>

#include <cstdlib>
#include <iostream>
#include <memory>

namespace
{

class HelloManager : public Rabit::RabitManager
{
public:
    // A count of 0 or less means endlessly.
    explicit HelloManager(int count) : RabitManager("HelloManager"), _remaining(count)
    {
        SetWakeupTimeDelayMSec(1000);
    }

    void ExecuteUnitOfWork() final
    {
        std::cout << "Hello World" << std::endl;
        if (_remaining > 0 && --_remaining == 0)
        {
            ShutdownAllManagers(true);
        }
    }

    void Shutdown() final { std::cout << "Good bye" << std::endl; }

private:
    int _remaining;
};

}  // namespace

int main(int argc, char **argv)
{
    Rabit::RabitReactor reactor;
    reactor.AddManager(std::make_unique<HelloManager>(argc > 1 ? std::atoi(argv[1]) : 0));
    reactor.Run();
    return 0;
}
