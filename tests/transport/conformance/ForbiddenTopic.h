// A topic that the permissions of a member lack, beside one that they have.
#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>

#include "Recorder.h"
#include "TestSample.h"
#include "TransportHarness.h"

namespace Rabit::Conformance
{

struct BesideForbidden
{
    bool IsPoseHeard = false;
    // Of the topic `Secret`.
    int Writers = 0;  // that match its reader
    int Readers = 0;  // that match its writer
    std::size_t Heard = 0;
};

// Sends the topics `Secret` and `Pose` until a pose is heard. `Secret` is announced first, and must keep
// nothing back.
inline BesideForbidden TalkBesideForbidden(TransportHarness &net, TransportSession &writing,
                                           TransportSession &reading)
{
    SampleRecorder secrets;
    SampleRecorder poses;
    const auto secret = writing.CreateWriter(TextTopic("Secret"), State(), {});
    const auto pose = writing.CreateWriter(TextTopic("Pose"), State(), {});
    const auto secretReader = reading.CreateReader(TextTopic("Secret"), State(), {}, secrets.Handler());
    const auto poseReader = reading.CreateReader(TextTopic("Pose"), State(), {}, poses.Handler());
    const bool isHeard = net.Until(
        [&]
        {
            WriteOnceTaken(*secret, MakeSample(0, "secret"), 1);
            WriteOnceTaken(*pose, MakeSample(0, "pose"), 1);
            return poses.Count() > 0;
        });
    return {.IsPoseHeard = isHeard,
            .Writers = static_cast<int>(secretReader->MatchedWriters()),
            .Readers = static_cast<int>(secret->MatchedReaders()),
            .Heard = secrets.Count()};
}

}  // namespace Rabit::Conformance
