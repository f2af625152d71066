// Ranks that are threads here and speak through queues.
#pragma once

#include <chrono>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "renderer/render/peers.h"
#include "renderer/render/ranks/messages.h"

namespace lull::ranks_test {

struct Habits {
    // How long rank 0 sleeps when it has sent a mere word, so that the others answer meanwhile.
    std::chrono::milliseconds nap{0};
    // The rank that neither sends nor receives after so many messages of its own; -1: none.
    int sleeper = -1, messagesBefore = 0;
};

struct Mailboxes {
    Habits how;
    std::mutex mutex;
    std::vector<std::deque<PeerMessage>> boxes;
    int64_t bytes = 0;
    bool isOver = false;  // for the sleeper too
};

class QueuePeers final : public Peers {
  public:
    QueuePeers(Mailboxes* mail, int rank) : mail(mail), rank(rank) {}
    int Rank() const override { return rank; }
    int Count() const override { return int(mail->boxes.size()); }
    void Send(int to, std::vector<std::byte> message) override {
        const bool isWord = message.size() == 1;
        {
            std::lock_guard lock(mail->mutex);
            if (Sleeps()) return;
            ++messages;
            mail->bytes += int64_t(message.size());
            mail->boxes[size_t(to)].push_back({rank, std::move(message)});
        }
        if (rank == 0 && isWord) std::this_thread::sleep_for(mail->how.nap);
    }
    std::optional<PeerMessage> Receive() override {
        std::lock_guard lock(mail->mutex);
        std::deque<PeerMessage>& box = mail->boxes[size_t(rank)];
        if (Sleeps() && mail->isOver && !std::exchange(hasEnded, true))
            return PeerMessage{0, Pack(RankWord::End)};
        if (box.empty() || Sleeps()) return {};
        PeerMessage message = std::move(box.front());
        box.pop_front();
        return message;
    }
    void Flush() override {}
    void GiveUp(int) override {}

  private:
    bool Sleeps() const {
        return rank == mail->how.sleeper && messages >= mail->how.messagesBefore;
    }

    Mailboxes* mail;
    int rank;
    int messages = 0;  // that were sent
    bool hasEnded = false;
};

}  // namespace lull::ranks_test
