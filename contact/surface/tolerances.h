// tolerances: the two that the numbers of a finger's contacts follow from, a way and an angle.
//
//   w = r / 16                      a way of the centre that is short beside the finger [m]: half a millimetre for a
//                                   tip of 8 mm, 0.5 m/s at 1 kHz. Places nearer to a contact than w are beside it.
//   a = 3.6 degrees, cos a = 0.998  normals that differ by less belong to one contact: on the finger the two
//                                   are one place within r a = w.
//
// Larger w: fewer looks and tries, contacts known later by as much. Larger a: contacts in shallow grooves count as one.
#pragma once

namespace pincer::contact {

constexpr double kWay = 1.0 / 16;  // w, of r, or of the reach where looks are meant
constexpr double kApart = 0.998;   // cos a

// A look holds for 2 w; alone for w at least, or it isn't worth it, and no more than 4 w, less than any height h.
constexpr double kLookHorizon = 2 * kWay, kLeastAlone = kWay, kMostAlone = 4 * kWay;
// A centre that moved by 8 w in one query was put there, not led. 4 w above the surface it isn't under it in the next.
constexpr double kLeap = 8 * kWay, kWellAbove = 4 * kWay;
// A contact that is found again is as deep as the lost one to within 8 w.
constexpr double kSameDepth = 8 * kWay;

// cos a/2, rounded up: contacts' normals that have turned by less leave what is within a/2 of them to them.
constexpr double kHalfApart = 0.999505, kHalfApartSine = 0.031461;  // the sine rounded up
static_assert(2 * kHalfApart * kHalfApart - 1 > kApart);
static_assert(kHalfApartSine * kHalfApartSine > 1 - kHalfApart * kHalfApart);
// cos 4 a: a normal that far from a patch's corners' still belongs to it.
constexpr double kBeside = 8 * kApart * kApart * (kApart * kApart - 1) + 1;

// 1 - cos a, of r: by so much the height over a place changes where the normal turns by a. A search's place that is
// nearer than its contact by more, and a quarter, isn't the contact's; contacts nearer to each other than half are one.
constexpr double kStrayed = 1.25 * (1 - kApart), kOnePlace = 0.5 * (1 - kApart);

// Round-off of differences between coordinates, of the mesh's size.
constexpr double kRoundOff = 1e-12;

}  // namespace pincer::contact
