--------------------------- MODULE KeyFlowsDisplay ---------------------------
(***************************************************************************)
(* KeyFlows with the wire that brings the active mode to the panel.  None  *)
(* of the note's four words does (E-25): the mode outputs themselves are   *)
(* read, sent to the panel by a wire of its own, and displayed by every    *)
(* scan of the panel (A-33).  It may be late, as every word may be.        *)
(* Leaves out: how late; a display that is switched off.                   *)
(***************************************************************************)
EXTENDS KeyFlows

CONSTANT DISPLAY_FAULT  \* what may happen to the wire: "none", "lost" or "wrong" (both break A-33)

VARIABLES
    carried,      \* the mode that the wire holds out to the panel, or None
    displayed,    \* the mode that the panel displays as active, or None
    come          \* how far the mode outputs have come since they last changed: 0, 1 the wire, 2 the panel

ASSUME DISPLAY_FAULT \in {"none", "lost", "wrong"}

display == <<carried, displayed, come>>
DisplayView == <<View, display>>
DisplayTypeOK == carried \in MSO \cup {None} /\ displayed \in MSO \cup {None} /\ come \in 0..2

DisplayInit == Init /\ carried = None /\ displayed = None /\ come = 2

\* EKS-8-8, E-25: the outputs themselves
Read == ActiveMSO
\* A-33: what arrives on the wire
Arrives ==
    CASE DISPLAY_FAULT = "lost" -> {Read, carried}
      [] DISPLAY_FAULT = "wrong" -> {Read} \cup {m \in MSO : \E l \in LEVELS : Permitted(l, m)}
      [] OTHER -> {Read}
\* EKS-8-8: one more value that is sent; what is there already is sent again
Carry ==
    /\ carried' \in Arrives /\ UNCHANGED displayed
    /\ come' = IF come = 0 THEN 1 ELSE come
    /\ <<carried, come>>' # <<carried, come>>
    /\ UNCHANGED <<reader, eks, fplc, plc, hmi, history>>
    /\ Took(0) /\ Did("Carry")
\* EKS-8-8, EKS-8-16: what the panel displays after a scan: what the wire brought, whatever else the scan does
Shows == displayed' = Displays([ActiveMSO |-> carried]) /\ come' = (IF come = 1 THEN 2 ELSE come) /\ UNCHANGED carried
Keeps == UNCHANGED <<carried, displayed>> /\ come' = IF mode' = mode THEN come ELSE 0

DisplayNext == ((User \/ EksRuns \/ FplcRuns \/ PlcRuns) /\ Keeps) \/ (PanelRuns /\ Shows) \/ Carry
DisplaySpec == DisplayInit /\ [][DisplayNext]_<<vars, display>>

\* EKS-8-8, EKS-8-16, E-25: once the wire has carried the outputs and the panel has scanned, it displays the mode
DisplayIsTheMode == come = 2 => displayed = ActiveMSO
=============================================================================
