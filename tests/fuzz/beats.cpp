// Beats on the topic of presence.
#include "Input.h"
#include "presence/PresenceInbox.h"
#include "wire/BeatExtensions.h"

int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    Rabit::PresenceInbox inbox;
    Rabit::SampleInfo info;
    info.Node = "uav1";
    info.Alive = true;
    const std::vector<std::uint8_t> bytes(data, data + size);
    inbox.AddBeat(bytes, info, std::chrono::seconds(1));
    const auto contents = inbox.Take();
    for (const auto &heard : contents.Beats)
    {
        Rabit::BeatExtensions::IsTool(heard.Beat);
        Rabit::BeatExtensions::IsReplay(heard.Beat);
        Rabit::BeatExtensions::TypeQuestionsIn(heard.Beat);
        Fuzz::Require(Rabit::BeatExtensions::StrainsIn(heard.Beat).size() <=
                      Rabit::BeatExtensions::MostStrains);
    }
    return 0;
}
