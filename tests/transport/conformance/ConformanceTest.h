// The base of the conformance suite: tests of what Transport.h promises, the same for every backend.
//
// A backend joins by an own test program that links rabit_transport_conformance and says
//   INSTANTIATE_TEST_SUITE_P(Its, Conformance, testing::Values(HarnessMaker{"its name", &Make}));
#pragma once

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <vector>

#include "Recorder.h"
#include "TestSample.h"
#include "TransportHarness.h"

namespace Rabit::Conformance
{

class Conformance : public testing::TestWithParam<HarnessMaker>
{
protected:
    using SessionPtr = std::unique_ptr<TransportSession>;
    using WriterPtr = std::unique_ptr<TransportWriter>;
    using ReaderPtr = std::unique_ptr<TransportReader>;

    SessionPtr Open(const std::string &node, std::uint64_t incarnation = 1, PeerHandler onPeer = {},
                    std::function<void(const std::string &)> log = {})
    {
        TransportSettings settings = Net().SettingsFor(node, incarnation);
        settings.Log = std::move(log);
        return Net().Backend().Open(settings, std::move(onPeer));
    }
    // Opens a session that forgets peers after three seconds of silence.
    SessionPtr OpenForgetful(const std::string &node, PeerHandler onPeer)
    {
        TransportSettings settings = Net().SettingsFor(node, 1);
        settings.Memory = std::chrono::seconds(3);
        return Net().Backend().Open(settings, std::move(onPeer));
    }
    TransportHarness &Net() { return *_harness; }
    bool Until(const std::function<bool()> &condition) { return Net().Until(condition); }

    // Waits until both sides know of the match, so that nothing written later is missed.
    bool Matched(const WriterPtr &writer, const ReaderPtr &reader)
    {
        return Until([&] { return writer->MatchedReaders() == 1 && reader->MatchedWriters() == 1; });
    }

    // Expects that a sample with a body of `size` bytes arrives whole.
    void ExpectArrivalOf(std::size_t size);
    // Expects that each write to two remote readers takes `destinations` datagrams, no larger than they
    // need to be.
    void ExpectCostOfWriting(bool multicast, int destinations);
    // Expects that samples of two writers to two remote readers go in `destinations` datagrams if they are
    // written in one turn.
    void ExpectOneDatagramForATurn(bool multicast, std::uint64_t destinations);
    // Expects that a sample written to one node reaches its reader alone, in one datagram.
    void ExpectThatOneNodeCanBeWrittenTo(bool multicast);
    // Expects that a held large sample goes out one datagram at a time.
    void ExpectThatALargeSampleCanBeHeld(bool multicast);
    // Expects that best-effort readers of a reliable writer cost it its samples and nothing else.
    void ExpectNothingButSamplesForBestEffortReaders(bool multicast, int destinations);
    // Expects that a reliable writer sends heartbeats and its reader acknowledges. When this returns, earlier
    // samples would have had theirs.
    void ExpectHeartbeatsAndAcknowledgements(bool multicast);
    SessionPtr OpenWith(const std::string &node, bool multicast, std::uint64_t incarnation = 1);
    // Returns what a new reader in `late` hears of a keyed state writer, up to the marker that is written for
    // it.
    std::vector<Received> HeardByALateReader(TransportSession &late, TransportWriter &writer);
    // Waits until all readers have acknowledged what this keyed state writer has written.
    bool AllAcknowledged(TransportSession &late, TransportWriter &writer);

private:
    const std::unique_ptr<TransportHarness> _harness = GetParam().Make();
};

}  // namespace Rabit::Conformance
