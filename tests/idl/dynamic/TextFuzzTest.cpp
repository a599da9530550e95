// Texts of strangers: each text is a type that works, or is refused with a reason. AddressSanitizer also
// finds the C parser's leaks, and its writes into memory of ours. RABIT_FUZZ_ROUNDS gives the number of
// texts, RABIT_FUZZ_SEED the first seed.
#include "CorpusTest.h"
#include "RandomSample.h"
#include "TextMutator.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <random>

#include "../../sanitizers/Sanitized.h"

namespace
{

// Sanitizers take some tens of milliseconds for a text.
#ifdef RABIT_SANITIZED
constexpr unsigned UsualRounds = 300;
#else
constexpr unsigned UsualRounds = 5000;
#endif

unsigned FromEnvironment(const char *name, unsigned otherwise)
{
    const char *value = std::getenv(name);
    return value == nullptr ? otherwise : static_cast<unsigned>(std::strtoul(value, nullptr, 10));
}

// Returns a name that the text may define: one of the corpus, so that most fit.
std::string NameIn(const std::string &text, const std::vector<std::string> &names, std::mt19937 &random)
{
    const std::size_t first = random() % names.size();
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        const std::string &name = names[(first + i) % names.size()];
        if (text.find("struct " + name.substr(name.rfind(':') + 1) + " ") != std::string::npos)
        {
            return name;
        }
    }
    return names[random() % names.size()];
}

void UseType(const Rabit::DynamicType &type, std::mt19937 &random)
{
    const Bytes &fresh = type.DefaultSample();
    ASSERT_EQ(type.Normalized(fresh), fresh);
    const auto json = type.ToJson(fresh);
    if (json)  // else larger than its bytes allow
    {
        const auto again = type.FromJson(*json);
        ASSERT_TRUE(again.Sample) << again.Reason;
        ASSERT_EQ(*again.Sample, fresh) << *json;
    }
    Bytes sample(4 + random() % 100);
    for (std::uint8_t &byte : sample)
    {
        byte = static_cast<std::uint8_t>(random() % 3 == 0 ? random() : random() % 4);
    }
    sample[0] = 0;
    sample[1] = static_cast<std::uint8_t>(random() % 2);
    std::array<std::uint8_t, 16> hash{};
    const auto normal = type.Normalized(sample);
    ASSERT_EQ(type.KeyHashOf(sample, hash), normal && type.HasKey());
    type.ToJson(sample);
    type.ToText(sample);
    if (normal)
    {
        ASSERT_EQ(type.Normalized(*normal), normal);
    }
}

TEST(TextFuzz, EveryTextIsATypeThatWorksOrIsRefusedWithAReason)
{
    const std::vector<std::string> names = Rabit::MessageTypeRegistry::Names();
    std::vector<std::string> texts;
    for (const std::string &name : names)
    {
        texts.push_back(Rabit::MessageTypeRegistry::Find(name)->IdlText());
    }
    const unsigned seed = FromEnvironment("RABIT_FUZZ_SEED", 1);
    const unsigned rounds = FromEnvironment("RABIT_FUZZ_ROUNDS", UsualRounds);
    TextMutator mutator(texts, seed);
    std::mt19937 random(seed);
    unsigned types = 0;
    for (unsigned round = 0; round < rounds; ++round)
    {
        const std::string text = mutator.Next();
        const auto parsed = Rabit::DynamicType::Parse(text, NameIn(text, names, random));
        if (!parsed.Type)
        {
            ASSERT_FALSE(parsed.Reason.empty()) << text;
            ASSERT_TRUE(std::all_of(parsed.Reason.begin(), parsed.Reason.end(),
                                    [](unsigned char letter) { return letter >= 0x20 && letter < 0x7f; }))
                << parsed.Reason;
            continue;
        }
        ++types;
        ASSERT_EQ(parsed.Reason, "");
        ASSERT_NO_FATAL_FAILURE(UseType(*parsed.Type, random)) << "round " << round << "\n" << text;
    }
    // With fewer, the texts are too damaged to try anything behind the parser.
    EXPECT_GT(types, rounds / 20);
    RecordProperty("types", static_cast<int>(types));
}

}  // namespace
