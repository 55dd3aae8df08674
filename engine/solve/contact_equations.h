// contact_equations: the linear equations of Newton's and of the interior-point method.
//
//   E_i x_i + P_i (W^ x)_i = b_i      per contact i;  E_i, P_i are rows x rows blocks, W^ = A^ A^^T (scaled_problem.h)
//
// Two ways to the same x, chosen once per solve:
//   contact by contact   E + P W^ as a dense matrix of the contacts' rows. For few contacts.
//   mover by mover       with y = A^T x:  (I + A^T G A) y = A^T K^-1 b,   x = K^-1 b - G A y
//                        K = E + P R,   G = K^-1 P
//     A mover that only one contact touches is no unknown but part of R_i: fingers around an object cost 6
//     unknowns, not 6 per finger. The rest is block-sparse by the graph of movers (block_lu.h). For redundant
//     contacts (many on few movers), and for many contacts.
// Source: the second is Woodbury's identity (Golub, Van Loan, Matrix Computations, 4th ed., section 2.1.4) on V. Acary,
// M. Bremond, O. Huber, Advanced Topics in Nonsmooth Dynamics (2018), eq. (9.57).
#pragma once
#include "pincer/engine/solve/scaled_problem.h"

namespace pincer::engine {

// From which way the equations of `problem` are to be solved; fills scratch's structure of movers. Too large: there is
// no memory for either.
enum class EquationForm : unsigned char { kContacts, kMovers, kTooLarge };
EquationForm chooseForm(const ContactProblem& problem, SolverScratch& scratch);

class ContactEquations {
 public:
  ContactEquations(const ScaledProblem& problem, EquationForm form, SolverScratch& scratch);

  // Contact i's equation: x_i = b_i;  epsilon x_i + (W^ x)_i = b_i;  or E x_i + P (W^ x)_i = b_i,
  // row-major with stride 4.
  void decouple(int i) { terms_[i].coupling = Coupling::kNone; }
  void identify(int i, double epsilon);
  void setGeneral(int i, const double* E, const double* P);

  // False if the equations are singular, or cost more than what is left of the budget.
  bool factorise();
  // x: b on entry.
  void solve(double* x);
  EquationForm form() const { return form_; }

 private:
  std::int64_t cost() const;
  int assembleRows(int i, int row);
  bool factoriseContacts();
  bool factoriseMovers();
  void eliminate(int i);
  void addToMovers(int i);
  void solveContacts(double* x);
  void solveMovers(double* x);

  const ScaledProblem& problem_;
  const EquationForm form_;
  SolverScratch& scratch_;
  ContactTerms* const terms_;
  double* const A_;
  int* const active_;
  int active_count_ = 0, size_ = 0;
  bool symmetric_ = true;
};

}  // namespace pincer::engine
