------------------------------ MODULE EksTrace ------------------------------
(***************************************************************************)
(* What one line of a log says about a scan of the EKS.  w holds the       *)
(* inputs by their names in interface.toml, and dt.  The keys are those    *)
(* that the log shows, numbered in the order of SEEN; DEVICE_CHECKSUM is   *)
(* what the device calculates.  Leaves out: nothing of Eks.                *)
(***************************************************************************)
EXTENDS Eks, Sequences

CONSTANTS
    SEEN,               \* the different inputs of the log, a sequence of records
    DEVICE_CHECKSUM     \* one checksum for all keys (A-14)

LoggedKeys == [n \in 1..Len(SEEN) |->
    [operating_state |-> SEEN[n].operating_state, authorization_level |-> SEEN[n].authorization_level,
     access_code |-> SEEN[n].access_code, KEYCRC |-> SEEN[n].KEYCRC, KeyID |-> SEEN[n].KeyID]]
LoggedChecksums == [n \in 1..Len(SEEN) |-> DEVICE_CHECKSUM]

LOCAL SameKey(k, w) ==
    /\ k.operating_state = w.operating_state /\ k.authorization_level = w.authorization_level
    /\ k.access_code = w.access_code /\ k.KEYCRC = w.KEYCRC /\ k.KeyID = w.KeyID
LOCAL Number(w) ==
    CHOOSE n \in DOMAIN KEY : SameKey(KEY[n], w) /\ \A m \in 1..n - 1 : ~SameKey(KEY[m], w)
EksRead(w) ==
    [key |-> IF w.inserted THEN Number(w) ELSE None, registers_zero |-> w.registers_zero, dt |-> w.dt]

LOCAL RightChecksum(k) == KEY[k].KEYCRC = CHECKSUM[k]
\* EKS-2-3, EKS-2-4, EKS-2-5, EKS-8-5: which key can be in memory in which state
EksAnywhere ==
    /\ eksState \in EksStates
    /\ key \in CASE eksState \in {"Empty", "CheckRegisters", "Fault"} -> {None}
                 [] eksState \in {"Read", "CheckChecksum"} -> DOMAIN KEY
                 [] eksState = "CheckLevel" -> {k \in DOMAIN KEY : RightChecksum(k)}
                 [] eksState = "Rejected" -> {k \in DOMAIN KEY : ~RightChecksum(k) \/ ~Accepted(k)}
                 [] OTHER -> {k \in DOMAIN KEY : RightChecksum(k) /\ Accepted(k)}
    /\ eksElapsed \in IF eksState \in {"TestOnes", "TestZeros"} THEN 0..T_PULSE - 1 ELSE {0}
    /\ step = ""
=============================================================================
