// A fleet with keys in a folder of the test's own.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "keys/Certificates.h"
#include "keys/FleetKeys.h"
#include "keys/KeyFiles.h"
#include "keys/KeysError.h"
#include "keys/SignedDocument.h"

namespace Rabit::Keys
{

inline constexpr std::time_t TestDay = 24 * 60 * 60;
// 2026-11-23, noon
inline constexpr std::time_t TestNow = 1795435200;

class KeysFolder : public testing::Test
{
protected:
    KeysFolder()
        : Root(testing::TempDir() + "rabit-keys-" + std::to_string(::getpid()) + "-" +
               testing::UnitTest::GetInstance()->current_test_info()->name())
    {
        std::filesystem::remove_all(Root);
        std::filesystem::create_directories(Root);
        FleetKeys::Init(Place(), "blue", {.Now = TestNow, .Days = 3650});
    }
    ~KeysFolder() override { std::filesystem::remove_all(Root); }

    std::string Place() const { return Root + "/keys"; }
    std::string FolderOf(const std::string &node) const { return Place() + "/" + node; }

    static FleetKeys::Request RequestFor(const std::string &node, const std::string &transport = "fastdds")
    {
        return {.Node = node,
                .SmallGuid = WantsSmallGuid(transport),
                .Access = {.Domain = 7,
                           .Publish = {{"rabit/Link", {""}}, {"Pose", {"", node}}},
                           .Subscribe = {{"rabit/Link", {""}}, {"Pose", {"uav*"}}}}};
    }
    void Add(const std::string &node, const std::string &transport = "fastdds", std::time_t now = TestNow,
             int days = 365) const
    {
        FleetKeys(Place()).Add(RequestFor(node, transport), {.Now = now, .Days = days});
    }

    // Replaces `old` by `now` in an existing document, and signs it anew.
    void Rewrite(const std::string &file, const std::string &old, const std::string &now,
                 const std::string &authority = "permissions") const
    {
        const std::string place = Place() + "/authority/";
        const CertificatePtr right = ReadCertificate(ReadFile(place + "permissions.pem"), "");
        std::string text = VerifiedDocument(ReadFile(file), *right, file);
        if (!old.empty())
        {
            ASSERT_NE(text.find(old), std::string::npos) << text;
            text.replace(text.find(old), old.size(), now);
        }
        const CertificatePtr signer = ReadCertificate(ReadFile(place + authority + ".pem"), "");
        const KeyPtr key = ReadKey(ReadSecret(place + authority + "_key.pem"), "");
        WriteFile(file, SignDocument(text, *signer, *key));
    }

    // Replaces the list of revoked certificates in `folder` by an empty one, which the authority `by` of the
    // fleet in `fleet` signs.
    void Relist(const std::string &folder, const std::string &fleet, const std::string &by,
                const Validity &validity) const
    {
        const std::string place = fleet + "/authority/" + by;
        const CertificatePtr authority = ReadCertificate(ReadFile(place + ".pem"), "");
        const KeyPtr key = ReadKey(ReadSecret(place + "_key.pem"), "");
        const RevocationsPtr list = MakeRevocations(nullptr, {}, *authority, *key, TestNow);
        const TimePtr from(ASN1_TIME_set(nullptr, validity.From));
        const TimePtr to(ASN1_TIME_set(nullptr, validity.To));
        ASSERT_EQ(X509_CRL_set1_lastUpdate(list.get(), from.get()), 1);
        ASSERT_EQ(X509_CRL_set1_nextUpdate(list.get(), to.get()), 1);
        ASSERT_GT(X509_CRL_sign(list.get(), key.get(), EVP_sha256()), 0);
        WriteFile(NodeFiles(folder).Revoked, PemOf(*list));
    }

    // Returns the error that NodeKeys throws for this folder; empty if it throws none.
    static std::string WhyNoKeys(const std::string &folder)
    {
        return WhyNot([&] { const NodeKeys keys(folder); });
    }
    template <typename Work>
    static std::string WhyNot(const Work &work)
    {
        try
        {
            work();
            return "";
        }
        catch (const KeysError &error)
        {
            return error.what();
        }
    }

    const std::string Root;
};

}  // namespace Rabit::Keys
