------------------------------ MODULE PlcTrace ------------------------------
(***************************************************************************)
(* What one line of a log says about a scan of the PLC.  w holds the four  *)
(* words that it reads by their names in interface.toml.                   *)
(* Leaves out: nothing of Plc.                                             *)
(***************************************************************************)
EXTENDS Plc

PlcRead(w) == [MW01 |-> w.MW01, MW05 |-> w.MW05, SelectMSO |-> w.SelectMSO, SwitchMSO |-> w.SwitchMSO]

\* The words of the log are WORDS: a word that it never shows makes no difference to a device that only copies
PlcAnywhere ==
    /\ turn \in {"CopyReadAuthorization", "CopyMW03", "CopyCheckMSO", "CopyMW07"}
    /\ ReadAuthorization \in WORDS /\ MW03 \in WORDS /\ CheckMSO \in WORDS /\ MW07 \in WORDS
    /\ step = ""
=============================================================================
