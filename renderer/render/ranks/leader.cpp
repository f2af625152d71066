// Rank 0: asks the criteria, writes checkpoints, deals out tiles, and says when to end.
#include <algorithm>
#include <atomic>
#include <map>
#include <numeric>

#include "renderer/render/light_rounds.h"
#include "renderer/render/ranks/rank.h"

namespace lull {

namespace {

constexpr double kLeastGain = 1.1;  // speedup by other shares of the tiles that is worth a pause
constexpr double kLeastRun = 20;    // until the next pause, in lengths of the last

class Leader {
  public:
    Leader(const RenderOptions& options, tbb::task_arena* arena)
        : options(options),
          film(options.film),
          rank(options, arena,
               {.onPassEnd = [this](int block) { EndPass(block); },
                .completeView = [this](int block, FilmView* view) { CompleteView(block, view); },
                .onDecided = [this](int block, const BlockAnswer& a) { TellAnswer(block, a); },
                .onException = {}}),
          speeds(options.peers->Count()),
          nextDeal(executor.ledger.Seconds() + options.dealInterval) {
        ForgetParts();
    }

    // After an exception no task is at work.
    RenderResult Lead() try {
        SendStart({});
        executor.RestartIntervals();
        // Passes that an interruption has cut off need the light of their round, too.
        if (options.lightRounds && !schedule.IsOver()) EndLightRound();
        for (;;) {
            executor.pausing = hasGivenUp;
            rank.EnqueueReady();
            RunUntilPause();
            if (schedule.IsRoundOver() && !schedule.IsOver() && !executor.IsCancelled()) {
                executor.Quiesce();
                EndLightRound();
                continue;
            }
            const double pause = Seconds();
            const bool undo = schedule.TimeCalled() && IsOver() && !executor.IsCancelled();
            Gather(undo);
            if (options.lightRounds && !undo && !hasGivenUp && schedule.Unlocked().NoPassUnderWay())
                LearnLight();
            const bool takesOver = std::exchange(hasGivenUp, false) && !executor.IsCancelled();
            const bool over = !takesOver && IsOver() &&
                              (undo || !schedule.TimeCalled() || executor.IsCancelled());
            if (over || Seconds() >= executor.nextCheckpoint) WriteCheckpoint();
            if (over) break;
            executor.ShowPreview(pause);
            if (takesOver)
                TakeOver();
            else if (deal.empty() || schedule.TimeCalled())
                channel.PostToAll(Pack(RankWord::Resume));
            else
                Deal(executor.ledger.Blocks(schedule.Unlocked()));
            nextDeal = Seconds() + std::max(options.dealInterval, kLeastRun * (Seconds() - pause));
        }
        channel.PostToAll(Pack(RankWord::End));
        Exchange();  // sends the last word
        channel.Flush();
        RenderResult result = executor.Result();
        const std::vector<int>& dealt = schedule.Share().deal;
        for (int other = 0; other < channel.Count(); ++other)
            result.shares.push_back(double(std::ranges::count(dealt, other)) /
                                    double(dealt.size()));
        return result;
    } catch (...) {
        executor.Quiesce();
        throw;
    }

  private:
    // Learns from the samples of all ranks, if a round has ended, and lets each of them trace a
    // part of the light of the next, of which all of them need the whole.
    void EndLightRound() {
        LightRounds& rounds = *options.lightRounds;
        if (rounds.End() > 0) {
            Gather(false);
            if (executor.IsCancelled()) return;  // what is here may not be all
            if (std::exchange(hasGivenUp, false)) return TakeOver();
            LearnLight();
        }
        executor.BeginLightRound([this] { WriteCheckpoint(); });
        splats.clear();
        traced.clear();
        executor.isLightTraced = true;
        channel.PostToAll(Pack(RankWord::Round, rounds.Round()));
        TracePart(0);
        Await(traced);
        for (int other = 1; other < channel.Count(); ++other)
            if (traced.contains(other))
                Merge(other);
            else
                TracePart(other);  // of one that was given up
        if (!executor.isLightTraced) return;
        for (size_t i = 0; i < rounds.Planes().size(); ++i)
            channel.PostToAll(PackSplats(int(i), rounds.Planes()[i]));
        channel.PostToAll(Pack(RankWord::Lit));
        schedule.BeginRound(LightRoundEnd(options));
    }

    // Learns from the samples of all ranks, which are here, once a round: whoever goes on from the
    // checkpoint has to know what was learned. The others forget the spreads when the next round
    // begins, and may have sent them again.
    void LearnLight() {
        LightRounds& rounds = *options.lightRounds;
        if (rounds.End() == 0) return;
        if (std::exchange(learnedEnd, rounds.End()) == rounds.End())
            film->ForgetSpreads();
        else
            rounds.Learn(film);
    }

    void TracePart(int part) {
        std::atomic<bool> isDone = false;
        rank.Enqueue([&] {
            if (!options.lightRounds->Trace([this] { return executor.IsCancelled(); }, part,
                                            channel.Count()))
                executor.isLightTraced = false;
            isDone = true;
        });
        while (!isDone) {
            Exchange();
            WatchOthers();
        }
        executor.Quiesce();
    }

    void Merge(int from) {
        for (const std::vector<std::byte>& message : splats[from]) {
            StateReader reader(message);
            options.lightRounds->Planes().at(size_t(reader.Get<int>())).Merge(&reader);
        }
        splats.erase(from);
    }

    double Seconds() const { return executor.ledger.Seconds(); }
    void Exchange() {
        channel.Exchange(
            [this](int from, RankWord word, StateReader& reader) { Handle(from, word, reader); });
    }

    // Not while blocks are behind their criteria.
    void WriteCheckpoint() {
        if (!channel.HasGivenUpAny() || (answers.empty() && !AreBehind()))
            executor.WriteCheckpoint();
        else
            executor.nextCheckpoint = Seconds() + options.checkpoints.interval;
    }

    void Deal(const std::vector<BlockResult>& blocks) {
        const std::vector<int> before = schedule.Share().deal;
        schedule.Restart(StartsOf(blocks, options), {0, std::exchange(deal, {})});
        executor.ledger.TakeEffort();
        ForgetParts();
        SendStart(before);
        speeds.Forget();
    }

    // Deals out the tiles of ranks that were given up to the others. Where their samples are lost,
    // blocks go back by a pass, for which all those are taken again; the answer to it is known. A
    // pass that is under way takes them too.
    void TakeOver() {
        deal = schedule.Share().deal;
        std::erase_if(deal, [&](int other) { return channel.HasGivenUp(other); });
        std::vector<BlockResult> blocks = executor.ledger.Blocks(schedule.Unlocked());
        for (size_t i = 0; i < blocks.size(); ++i) {
            Block& block = blocks[i].block;
            if (!IsBehind(block) || MostSamples(block.pixels, *film) > block.spp) continue;
            answers.insert({int(i), {block.stoppedByVote, block.noise}});
            block.spp = PassStart(block.spp);
            block.stopped = block.stoppedByVote = false;
        }
        Deal(blocks);
    }

    bool IsBehind(const Block& block) const {
        for (int y = block.pixels.min.y(); y < block.pixels.max.y(); ++y)
            for (int x = block.pixels.min.x(); x < block.pixels.max.x(); ++x)
                if (film->At({x, y}).count < uint32_t(block.spp)) return true;
        return false;
    }
    bool AreBehind() {
        return std::ranges::any_of(executor.ledger.Blocks(schedule.Unlocked()),
                                   [&](const BlockResult& b) { return IsBehind(b.block); });
    }

    void ForgetParts() {
        parts.assign(schedule.Unlocked().Blocks().size(), {});
        missing.clear();
        for (int i = 0; i < int(parts.size()); ++i) missing.push_back(PartCount(i));
    }

    void ThinkOfDeal() {
        if (Seconds() < nextDeal || schedule.TimeCalled()) return;
        std::lock_guard lock(partsMutex);
        const std::vector<double> known = speeds.Speeds(options.dealInterval / 10);
        if (known.empty()) return;
        if (GainOfDealing(known, schedule.Share().deal) >= kLeastGain) {
            deal = DealBySpeed(known);
            executor.pausing = true;
        }
        speeds.Forget();
        nextDeal = Seconds() + options.dealInterval;
    }

    // Tells the others where the blocks are and who has which tiles, and gives them the sums of
    // those that they did not have by the deal before.
    void SendStart(const std::vector<int>& before) {
        std::vector<BlockStart> starts;
        std::vector<ViewNeed> needs;
        const std::span<const Block> blocks = schedule.Unlocked().Blocks();
        for (int i = 0; i < int(blocks.size()); ++i) {
            const Block& block = blocks[size_t(i)];
            const bool mustEnd = schedule.HasClock() && schedule.Unlocked().MustEnd(i);
            starts.push_back({block.spp, block.stopped, block.stoppedByVote, block.noise,
                              mustEnd ? schedule.Unlocked().PassEnd(i) : 0,
                              schedule.Unlocked().HasVoted(i)});
            needs.push_back(block.stopped ? ViewNeed::Nothing
                                          : executor.criteria.NeedAt(i, NextSpp(block.spp)));
        }
        channel.PostToAll(Pack(RankWord::Start, schedule.Share().deal, starts, needs));
        for (int to = 1; to < channel.Count() && executor.ledger.Samples() > 0; ++to)
            for (int i = 0; i < int(blocks.size()); ++i) {
                const std::vector<PixelRect> tiles = rank.NewTiles(i, to, before);
                if (!tiles.empty()) channel.Post(to, PackPixels(i, tiles, *film));
            }
        // The first round of light paths begins where its light has come (RankWord::Lit).
        if (!options.lightRounds || options.lightRounds->End() > 0)
            channel.PostToAll(Pack(RankWord::Begin));
    }

    int NextSpp(int spp) const { return PassEndAfter(spp, schedule.Unlocked().Options()); }

    int PassStart(int spp) const {
        int start = 0;
        for (int end = 0; (end = NextSpp(start)) < spp;) start = end;
        return start;
    }

    int PartCount(int block) const {
        int count = 0;
        for (int other = 0; other < channel.Count(); ++other)
            count += !schedule.TilesOfRank(block, other).empty();
        return count;
    }

    bool IsOver() { return executor.IsCancelled() || schedule.IsOver(); }

    void RunUntilPause() {
        while (!executor.pausing && !IsOver() && !schedule.IsRoundOver()) {
            Exchange();
            WatchOthers();
            if (schedule.HasClock() && !schedule.TimeCalled() && !(options.secondsLeft() > 0)) {
                schedule.CallTime();
                channel.PostToAll(Pack(RankWord::TimeUp));
            }
            // With new samples, so that the shortest interval leads to an end.
            if (executor.IsPauseDue() && executor.ledger.Samples() > samplesGathered)
                executor.pausing = true;
            ThinkOfDeal();
            executor.ledger.Report(&schedule);
        }
    }

    void Gather(bool undo) {
        quiet.clear();  // now: a rank that is idle answers before Exchange() returns
        collected.clear();
        channel.PostToAll(Pack(RankWord::Pause));
        Exchange();  // sends it
        executor.Quiesce();
        Await(quiet);
        executor.Quiesce();  // decisions on arrived messages
        if (undo) executor.Undo();
        channel.PostToAll(Pack(RankWord::Collect, undo));
        Await(collected);
        samplesGathered = film->SampleCount();
        executor.ledger.SetSamples(samplesGathered);
    }

    // Waits until all others have said a word, or the render is cancelled, as if one has died.
    void Await(const std::set<int>& heard) {
        const auto isAwaited = [&](int other) {
            return !channel.HasGivenUp(other) && !heard.contains(other);
        };
        std::vector<int> others(size_t(channel.Count()) - 1);
        std::iota(others.begin(), others.end(), 1);
        while (std::ranges::any_of(others, isAwaited)) {
            if (executor.IsCancelled() && !std::exchange(hasAsked, true))
                channel.AskForLife(others);
            Exchange();
            WatchOthers();
        }
    }

    void WatchOthers() {
        const double least = options.rankPatience / 12;
        double patience = executor.IsCancelled() ? least : options.rankPatience;
        if (schedule.HasClock()) patience = std::clamp(options.secondsLeft() / 10, least, patience);
        for (const int silent : channel.FindSilent(least / 5, patience)) {
            channel.GiveUp(silent);
            hasGivenUp = executor.pausing = true;
            if (options.events.onGivenUp) options.events.onGivenUp(silent, patience);
        }
    }

    void Handle(int from, RankWord word, StateReader& reader) {
        if (word == RankWord::Part) {
            const auto part = reader.Get<PartMessage>();
            TakePart(from, part, reader.GetVector<float>(kDamagedMessage));
        } else if (word == RankWord::Pixels) {
            const int block = GetBlock(reader, parts.size());
            GetPixels(reader, schedule.TilesOfRank(block, from), film);
        } else if (word == RankWord::Splats) {
            std::vector<std::byte>& message = splats[from].emplace_back(reader.Left());
            reader.GetAll(std::span(message));
        } else if (word == RankWord::Traced) {
            executor.isLightTraced = reader.Get<bool>() && executor.isLightTraced;
            traced.insert(from);
        } else if (word == RankWord::Quiet) {
            quiet.insert(from);
        } else if (word == RankWord::Collected) {
            collected.insert(from);
        } else if (word == RankWord::Interrupted) {
            executor.peerInterrupted = true;
        }
    }

    void TakePart(int from, const PartMessage& part, std::vector<float> values) {
        executor.ledger.AddPart(part.block, part.seconds, part.samples);
        {
            std::lock_guard lock(partsMutex);
            speeds.Add(from, part.samples, part.busySeconds);
            parts[size_t(part.block)].emplace_back(from, std::move(values));
        }
        if (IsLastPart(part.block)) rank.Enqueue([this, block = part.block] { Decide(block); });
    }

    bool IsLastPart(int block) {
        std::lock_guard lock(partsMutex);
        if (--missing[size_t(block)] > 0) return false;
        missing[size_t(block)] = PartCount(block);
        return true;
    }

    void Decide(int block) {
        std::unique_lock lock(partsMutex);
        const auto known = answers.extract(block);
        lock.unlock();
        if (known) {
            TellAnswer(block, known.mapped());
            executor.tasks.Spawn(schedule.Decide(block, known.mapped()));
        } else {
            executor.tasks.Spawn(executor.DecideBlock(block));
        }
    }

    void EndPass(int block) {
        const TileEffort own = rank.TakeEffort();
        {
            std::lock_guard lock(partsMutex);
            speeds.Add(0, own.samples, own.seconds);
        }
        if (IsLastPart(block)) Decide(block);
    }

    void CompleteView(int block, FilmView* view) {
        for (const auto& [from, values] : parts[size_t(block)])
            if (!values.empty())  // else its sums are here
                PutMeans(values, schedule.TilesOfRank(block, from), schedule.BlockAt(block).pixels,
                         view);
    }

    void TellAnswer(int block, const BlockAnswer& answer) {
        parts[size_t(block)].clear();
        const int next = NextSpp(schedule.Unlocked().PassEnd(block));
        const bool isAlone = schedule.BlockAt(block).partner < 0;
        const ViewNeed need =
            answer.stop && isAlone ? ViewNeed::Nothing : executor.criteria.NeedAt(block, next);
        channel.PostToAll(
            Pack(RankWord::Answer, AnswerMessage{block, answer.stop, answer.noise, need}));
    }

    const RenderOptions& options;
    Film* film;
    Rank rank;
    Executor& executor = rank.executor;
    LiveSchedule& schedule = executor.schedule;
    RankChannel& channel = rank.channel;

    std::mutex partsMutex;  // guards the members below, except in decisions, which have a
                            // block's parts
    // Of each block, the parts of its pass from other ranks, and the number of ranks that have
    // still to end theirs.
    std::vector<std::vector<std::pair<int, std::vector<float>>>> parts;
    std::vector<int> missing;
    std::map<int, BlockAnswer> answers;  // to passes that are done again, of these blocks
    RankSpeeds speeds;

    double nextDeal;                         // seconds, before which nobody thinks of it
    std::vector<int> deal;                   // that is to come; empty: none
    bool hasAsked = false;                   // whether the others are there
    std::set<int> quiet, collected, traced;  // ranks that have said so
    std::map<int, std::vector<std::vector<std::byte>>> splats;  // of the round, by rank
    int learnedEnd = 0;           // of the last round of light that was learned from
    int64_t samplesGathered = 0;  // at the last checkpoint
    bool hasGivenUp = false;      // a rank whose tiles are still to be taken over
};

}  // namespace

RenderResult LeadRanks(const RenderOptions& options, tbb::task_arena* arena) {
    return Leader(options, arena).Lead();
}

}  // namespace lull
