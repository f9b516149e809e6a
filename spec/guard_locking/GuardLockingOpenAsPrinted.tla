---------------------- MODULE GuardLockingOpenAsPrinted ----------------------
(***************************************************************************)
(* What an observer of the wires need not remember under a reading.        *)
(***************************************************************************)
EXTENDS GuardLockingOpen

----------------------------------------------------------------------------
\* GLF-07: where Reset is not remembered while inactive, nobody asks what it was then: an enable is two calls
\* away
ObservedView_ResetSeenOnlyWhileActive == <<View, requestSeen, asked, starting, lost, unguarded>>
=============================================================================
