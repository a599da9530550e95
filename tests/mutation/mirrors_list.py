"""Rules of how States are said once and repaired, broken on purpose. See mutations.py."""

from mutation import Mutation

MIRRORS = "gateway/mirrors/"
PROGRAM = "gateway_parts_test"


def repair(name, find, replace):
    return Mutation(name, MIRRORS + "StateRepair.cpp", find, replace, f"{PROGRAM}:StateRepairTest.*")


def version(name, find, replace):
    return Mutation(name, MIRRORS + "StateVersion.h", find, replace, f"{PROGRAM}:StateVersion.*")


def pace(name, find, replace):
    return Mutation(name, MIRRORS + "RepeatPace.h", find, replace, f"{PROGRAM}:RepeatPace.*")


def publisher(name, find, replace):
    return Mutation(name, MIRRORS + "TopicPublisher.cpp", find, replace, f"{PROGRAM}:*Publisher*")


def subscriber(name, find, replace):
    return Mutation(name, MIRRORS + "TopicSubscriber.cpp", find, replace, f"{PROGRAM}:TopicSubscriberTest.*")


MUTATIONS = [
    # When a State is asked for
    repair("who is heard first is given time", "entry.Judged ? AskAfter : Duration(0)", "AskAfter"),
    repair("a sample on its way is asked for", "entry.Judged ? AskAfter : Duration(0)", "Duration(0)"),
    repair("everything is new", "entry.Judged = true;", ""),
    repair("what is there is asked for", "return taken &&", "return false && taken &&"),
    repair("any value will do", "*taken > entry.Stated ||", "true ||"),
    repair("what is newer than the beat is a lack", "*taken > entry.Stated ||", ""),
    repair("versions tell the order", "*taken > entry.Stated ||",
           "static_cast<std::int32_t>(StateVersion::Of(*taken) - StateVersion::Of(entry.Stated)) > 0 ||"),
    repair("a version that came again is another", "StateVersion::Of(*taken) == StateVersion::Of(entry.Stated)",
           "*taken == entry.Stated"),
    repair("what was never written is asked for", "if (version == StateVersion::None)", "if (false)"),
    repair("what comes meanwhile is asked for", "if (entry.Request.Due() && Has(name, node, entry))", "if (false)"),
    repair("each beat begins the wait anew", "else if (!entry.Request.Due())", "else"),
    repair("one that is asked for again comes as quickly", "entry.Request.Done(now, node.RoundTrip + AskAfter);",
           "entry.Request.Begin(now + node.RoundTrip + AskAfter);"),
    Mutation("the wait grows without end", MIRRORS + "StateRepair.h", "2 * AskAfter, LongestWait",
             "2 * AskAfter, Duration::max()", f"{PROGRAM}:StateRepairTest.*"),
    Mutation("a lack remembers the wait of another", "base/include/rabit/base/Backoff.h", "_interval.Reset();", "",
             f"{PROGRAM}:StateRepairTest.*"),
    repair("the round trip does not count", "entry.Request.Done(now, node.RoundTrip + AskAfter)", "entry.Request.Done(now)"),
    repair("all ask at once", "Duration(0)) + Spread(others)", "Duration(0))"),
    repair("two ask as late as a crowd", "std::min(others, many)", "many"),
    repair("a crowd asks as late as it likes", "std::min(others, many)", "others"),
    # Lives
    repair("a former life tells of the present one", "|| found->second.Incarnation != told.Incarnation", ""),
    repair("what a former life had counts", "_takenIn(name, node.Incarnation,", "_takenIn(name, 1,"),
    repair("who is lost is asked", "Settle(found->second, entry);", ""),
    repair("who is forgotten is due", "_due.erase({*found->second.Due, node});", ""),
    repair("there is no end of nodes", "|| _nodes.size() >= MostNodes", ""),
    # Requests in beats
    repair("what came is asked for still", "entry.Asked = false;", ""),
    repair("that it came is not said", "node.Changed |= entry.Asked;", ""),
    repair("it is said again and again", "node.Changed = false;", ""),
    repair("what is no longer wanted is asked for", "if (asked) { _changed.insert(node); }", ""),
    repair("what one has the other has", "if (entry.Asked)", "if (entry.Asked && ask.States.empty() && node.Entries[0].Asked)"),
    # Versions
    version("versions change with the rounding", "(time & ~(Step - 1)) + Step / 2;\n    return Of(middle)",
            "(time & ~(Step - 1));\n    return Of(middle)"),
    version("a time has no version", "Of(middle) == None ? middle + Step : middle", "middle"),
    version("what follows has the same version", "Quantised(quantised + Step)", "Quantised(quantised + 1)"),
    version("versions that came again are the same",
            "(sourceTime & ~(Step - 1)) == (other & ~(Step - 1))", "Of(sourceTime) == Of(other)"),
    version("a version may be of the future", "middle > notAfter ? middle - Step : middle", "middle"),
    # When a State is written again
    pace("it is repeated at once however often", "isNew ? _gap.Reset() : static_cast<void>(_gap.Next());", ""),
    pace("a new value waits as long as an old one", "isNew ? _gap.Reset() : static_cast<void>(_gap.Next())", "_gap.Next()"),
    pace("there is no longest wait", "ShortestGap, LongestGap", "ShortestGap, Duration::max()"),
    pace("quiet is not rewarded", "now - *_lastAsked >= Quiet", "false"),
    pace("a question that crossed the answer is answered", "&& now - *_lastWritten >= ShortestGap",
         "&& now >= *_lastWritten"),
    pace("an answer is not the last", "_lastWritten = now; _waits = false;", "_lastWritten = now;"),
    publisher("telemetry is repeated", "if (_rule.Qos == QosProfile::State)", "if (true)"),
    publisher("what the network did not take has a version", "!isValue || result == WriteResult::TimedOut",
              "!isValue"),
    publisher("what can never be written has a version", "_writtenTime.reset();", ""),
    publisher("a State is told before its last datagram", "_isWhole = !IsUnderWay(); if (_isWhole)", "_isWhole = !IsUnderWay();"),
    publisher("what is under way is repeated", "_version != StateVersion::None && _isWhole", "_version != StateVersion::None"),
    publisher("two States of one moment are one", "? StateVersion::Next(_time) : time", "? _time : time"),
    publisher("times are as they are", "StateVersion::Quantised(_source.At(_local->GetPostTime().Monotonic))",
              "_source.At(_local->GetPostTime().Monotonic)"),
    publisher("what is asked for comes more often than the rule allows", "std::max(*repeat, mayWriteAt)", "*repeat"),
    publisher("what was never written is repeated", "if (_version != StateVersion::None && _isWhole)", "if (_isWhole)"),
    # Accepted samples
    subscriber("a State may be telemetry", "(_rule.Qos == QosProfile::State && offer != _rule.Qos)", "false"),
    subscriber("a State that comes again is posted", "(offer == QosProfile::State || _comesTwice) && IsRepetition(source, info)", "false"),
    subscriber("telemetry of one moment is one", "(offer == QosProfile::State || _comesTwice) && IsRepetition(source, info)",
               "IsRepetition(source, info)"),
    subscriber("what was overtaken is posted", "!posted || IsOvertaken(source, info)", "!posted"),
    subscriber("what is refused was taken in", "if (outcome != Outcome::Refused)", "if (true)"),
    subscriber("what does not decode is asked for again", "if (outcome != Outcome::Refused)",
               "if (outcome == Outcome::Posted || outcome == Outcome::Repeated)"),
    subscriber("another life's State was taken in", "found->second->Taken->Incarnation != incarnation", "false"),
    subscriber("an announcement is never taken back", "source->second->Offer = profile;",
               "source->second->Offer = profile ? profile : source->second->Offer;"),
    subscriber("a local message of another type is taken", "source.Local->Global() != nullptr", "true"),
]
