"""Slips and cheats of an author in this repository, each one line, and who notices. Data, no code."""

from __future__ import annotations

from tests.deep.tamper.trees import Case

EDM, OPEN, LIVE = "spec/edm/EDM.tla", "spec/edm/EDMOpen.tla", "spec/edm/EDMLive.tla"
PINNED = "is not the text that was pinned"


def says(name: str, file: str, old: str, new: str, of: str = PINNED) -> Case:
    """What a property or a theorem says is weakened: the registers of the document notice."""
    return Case(name, file, old, new, f"stage {file.split('/')[1]}", 1, of)


def contract(
    name: str, old: str, new: str, run: str = "MC_ModeSelection_anywhere", of: str = "VIOLATED"
) -> Case:
    """The contract page is weakened: TLC notices, on the contract alone."""
    file = "spec/mode_selection/ModeSelection.tla"
    return Case(f"contract: {name}", file, old, new, f"check {run} --quiet", 1, of)


PROPERTIES = (
    says(
        "a property becomes TRUE",
        OPEN,
        r"StopAtOnce == [][~Scanned.Activate \/ ~Scanned.S_OutControl => ~S_EDM_Out']_beat",
        "StopAtOnce == TRUE",
        "StopAtOnce: speaks of no variable",
    ),
    says(
        "a property becomes TRUE in every step",
        OPEN,
        "InactiveAtOnce == [][Ready' = Scanned.Activate]_beat",
        "InactiveAtOnce == [][TRUE]_beat",
        "InactiveAtOnce: speaks of no variable",
    ),
    says(
        "a property becomes TRUE by the back door",
        OPEN,
        "ResetNeverStarts == [][~S_EDM_Out /\\ S_EDM_Out' => released]_beat",
        "ResetNeverStarts == [][~S_EDM_Out /\\ S_EDM_Out' => released \\/ S_EDM_Out']_beat",
    ),
    says(
        "a property compares a variable with itself",
        OPEN,
        "[][S_EDM_Out /\\ S_EDM_Out' => OnTime \\/ BothAre(FALSE)]_beat",
        "[][state = state]_beat",
    ),
    says(
        "a property asks for more before it speaks",
        OPEN,
        "[][SafetyDemand /\\ Scanned.Activate /\\ ~OnTime",
        "[][SafetyDemand /\\ Scanned.Activate /\\ Scanned.Reset /\\ ~OnTime",
    ),
    says(
        "what a property refers to becomes TRUE",
        OPEN,
        "OnTime == unchanged + Scanned.dt < MONITORING_TIME",
        "OnTime == unchanged + Scanned.dt < MONITORING_TIME \\/ TRUE",
    ),
    says(
        "a list of allowed transitions becomes all states",
        OPEN,
        'CASE state = "Idle" -> {"Init"}',
        'CASE state = "Idle" -> EDMStates',
    ),
    says(
        "a property leaves out the decisive output",
        OPEN,
        'PowerUpIsSafe == step = "" => ~Ready /\\ ~S_EDM_Out',
        'PowerUpIsSafe == step = "" => ~Ready',
    ),
    says("the invariant of types allows more", EDM, "EDMTypeOK ==", "EDMTypeOK == TRUE \\/"),
    says(
        "a property is true of every state but one",
        EDM,
        "OutputNeedsAll == S_EDM_Out => Ready",
        'OutputNeedsAll == S_EDM_Out /\\ state # "OutputEnable" => Ready',
    ),
    says(
        "a goal that is always reached",
        LIVE,
        '<>(calm = "first") => <>[]S_EDM_Out',
        '<>(calm = "first") => <>[](S_EDM_Out \\/ ~S_EDM_Out)',
    ),
    says("a goal that the machine may leave again", LIVE, "<>[]S_EDM_Out", "<>S_EDM_Out"),
    says(
        "a specification with more fairness",
        LIVE,
        "/\\ WF_<<liveVars, step>>(CalmCall)",
        "/\\ SF_<<liveVars, step>>(CalmCall) /\\ WF_<<liveVars, step>>(CalmDown)",
    ),
    says(
        "a witness that reports what was not seen",
        "spec/edm/EDMWitness.tla",
        '/\\ (~OnTime => Report("ExpiresWithoutResult"))',
        '/\\ Report("ExpiresWithoutResult")',
    ),
    says(
        "a history that no property needs any more",
        "spec/edm/EDMDeactivation.tla",
        "ErrorOutlivesDeactivation == [][~S_EDM_Out /\\ S_EDM_Out' => ~unreset]_beat",
        "ErrorOutlivesDeactivation == [][~S_EDM_Out /\\ S_EDM_Out' => S_EDM_Out']_beat",
    ),
    says(
        "enable switch: one channel is left out",
        "spec/enable_switch/EnableSwitchOpen.tla",
        "/\\ Called.S_EnableSwitchCh1 /\\ ~Called.S_EnableSwitchCh2 /\\ Called.S_EnableSwitchCh3]_beat",
        "/\\ Called.S_EnableSwitchCh1 /\\ ~Called.S_EnableSwitchCh2]_beat",
    ),
    says(
        "enable switch: once is enough",
        "spec/enable_switch/EnableSwitchLive.tla",
        "EnablesAgain == []<>S_EnableSwitchOut",
        "EnablesAgain == <>S_EnableSwitchOut",
    ),
    says(
        "guard locking: the enable needs less",
        "spec/guard_locking/GuardLockingOpen.tla",
        "EnableNeedsSecuredGuard == [][S_GuardLocked' => Scanned.Activate /\\ Secure]_beat",
        "EnableNeedsSecuredGuard == [][S_GuardLocked' => Scanned.Activate]_beat",
    ),
    says(
        "guard locking: what was lost does not count",
        "spec/guard_locking/GuardLockingOpen.tla",
        "LossNeedsReset == [][S_GuardLocked' => ~lost']_beat",
        "LossNeedsReset == [][S_GuardLocked' => lost' \\in BOOLEAN]_beat",
    ),
    says(
        "sensor: a demand over a free sensor",
        "spec/testable_safety_sensor/TestableSafetySensorOpen.tla",
        'DemandNeedsDarkSensor == [][Then("SafetyDemand") => ~Scanned.S_OSSD_In]_beat',
        'DemandNeedsDarkSensor == [][Then("SafetyDemand") => Scanned.S_OSSD_In \\in BOOLEAN]_beat',
    ),
    says(
        "sensor: a failed test needs no reset",
        "spec/testable_safety_sensor/TestableSafetySensorOpen.tla",
        'FailedTestNeedsReset == [][Rise("S_OSSD_Out") => Edge \\/ (state \\notin TestErrors \\cup',
        'FailedTestNeedsReset == [][Rise("S_OSSD_Out") => Edge \\/ (state \\notin TestErrors \\cap',
    ),
    says(
        "mode selection: the user need not confirm",
        "spec/mode_selection/KeyFlows.tla",
        "Switched(m) => touched = m /\\ seen = m /\\ confirmed = m]_View",
        "Switched(m) => touched = m /\\ seen = m]_View",
    ),
    says(
        "mode selection: the contract holds at the beginning",
        "spec/mode_selection/KeyFlows.tla",
        "RefinesModeSelection == Contract!Spec",
        "RefinesModeSelection == Contract!Init",
    ),
    says(
        "mode selection: the contract is of other variables",
        "spec/mode_selection/KeyFlows.tla",
        "WITH level <- Signalled, mode <- ActiveMSO",
        "WITH level <- Signalled, mode <- None",
    ),
    says(
        "mode selection: the contract's own property is weaker",
        "spec/mode_selection/ModeSelectionAlone.tla",
        "/\\ mode' \\in MSO /\\ mode' = touched /\\ mode' = seen /\\ mode' = confirmed",
        "/\\ mode' \\in MSO /\\ mode' = confirmed",
    ),
)

CONTRACT = (
    contract(
        "nothing asks what was touched and seen", "    /\\ confirmed = touched /\\ confirmed = seen ", "    "
    ),
    contract("the level need not permit it", "level # None /\\ confirmed <= level ", "level # None "),
    contract("a mode that nobody confirmed", "/\\ mode' = confirmed", "/\\ mode' \\in {confirmed, level}"),
    contract(
        "a key takes the mode with it",
        "confirmed' = None /\\ UNCHANGED <<level, mode>>\n\n\\* EKS-2-7",
        "confirmed' = None /\\ mode' = None /\\ UNCHANGED level\n\n\\* EKS-2-7",
    ),
    contract(
        "a touch forgets nothing",
        "Touch == touched' \\in MSO /\\ seen' = None /\\ confirmed' = None /\\ UNCHANGED <<level, mode>>",
        "Touch == touched' \\in MSO /\\ UNCHANGED <<level, seen, confirmed, mode>>",
    ),
    contract(
        "a removal changes the mode",
        "UNCHANGED <<touched, seen, confirmed, mode>>",
        "UNCHANGED <<touched, seen, confirmed>> /\\ mode' \\in {mode, None}",
    ),
    contract(
        "the panel shows something else",
        "touched # None /\\ seen' = touched /\\",
        "touched # None /\\ seen' \\in MSO /\\",
        "MC_ModeSelection",
    ),
    contract(
        "a step that allows everything",
        "Next == Insert \\/",
        "Next == (mode' \\in MSO /\\ UNCHANGED <<level, touched, seen, confirmed>>) \\/ Insert \\/",
        "MC_ModeSelection",
    ),
    contract(
        "a mode at the beginning",
        "confirmed = None /\\ mode = None",
        "confirmed = None /\\ mode \\in MSO \\cup {None}",
        "MC_ModeSelection",
        "generated",
    ),
)

ROOM = "proofs/edm/block_safety.py"
THEOREMS = (
    says(
        "a theorem demands TRUE",
        ROOM,
        "    return TRUE, scan.sends.Ready == scan.inputs.Activate",
        "    return TRUE, TRUE",
    ),
    says(
        "a theorem demands less",
        ROOM,
        "    return stopped, z3.Not(scan.sends.S_EDM_Out)",
        "    return stopped, z3.Or(scan.sends.S_EDM_Out, z3.Not(scan.sends.S_EDM_Out))",
    ),
    says(
        "a theorem supposes more",
        ROOM,
        "    stopped = z3.Or(z3.Not(scan.inputs.Activate), z3.Not(scan.inputs.S_OutControl))",
        "    stopped = z3.And(z3.Not(scan.inputs.Activate), z3.Not(scan.inputs.S_OutControl))",
    ),
    says(
        "a theorem leaves out the decisive state",
        ROOM,
        "def inactive_at_once(scan: Scanned) -> Obligation:\n",
        "def inactive_at_once(scan: Scanned) -> Obligation:\n"
        '    if scan.was("OutputEnable"):\n        return None\n',
    ),
    says(
        "what a theorem refers to becomes TRUE",
        ROOM,
        "    term: z3.BoolRef = SEEN.unchanged + scan.inputs.dt_ms < scan.params.MonitoringTime_ms\n",
        "    term: z3.BoolRef = TRUE\n",
    ),
    says(
        "a table of a theorem allows more",
        ROOM,
        '    "Idle": ("Init",),',
        '    "Idle": ("Init", "OutputEnable"),',
    ),
    says(
        "the sentence of a theorem claims more than is asked",
        ROOM,
        '"""After every call Ready is what Activate was in it."""',
        '"""After every call every output is what Activate was in it."""',
    ),
    says(
        "a theorem of the plc leaves out the words",
        "proofs/mode_selection/plc_safety.py",
        "    return z3.And(_copied(scan, word), *others)",
        "    return z3.And(*others)",
    ),
    says(
        "a theorem allows every pair of steps",
        "proofs/mode_selection/fplc_order.py",
        "    return TRUE, TRUE if _pair(scan) in IN_ORDER | FROM_THE_SIDE else FALSE",
        "    return TRUE, TRUE",
    ),
    says(
        "a theorem of the enable switch is about nothing",
        "proofs/enable_switch/switch_safety.py",
        "def activate_goes_first(scan: Scanned) -> Obligation:\n"
        "    return TRUE, scan.sends.Ready == scan.inputs.Activate",
        "def activate_goes_first(scan: Scanned) -> Obligation:\n"
        "    return TRUE, scan.inputs.Activate == scan.inputs.Activate",
    ),
    says(
        "a theorem of guard locking forgets the guard",
        "proofs/guard_locking/block_safety.py",
        "scan.sends.S_GuardLocked, scan.inputs.Activate, secure(scan))",
        "scan.sends.S_GuardLocked, scan.inputs.Activate)",
    ),
    says(
        "a theorem of the sensor forgets the dark sensor",
        "proofs/testable_safety_sensor/sensor_safety.py",
        '    return TRUE, TRUE if scan.becomes("TestActive") else z3.Not(dark)',
        '    return TRUE, TRUE if scan.becomes("TestActive") else z3.Not(scan.sends.S_OSSD_Out == dark)',
    ),
    Case(
        "a theorem claims nothing",
        ROOM,
        "    yield from JUDGE.in_every_scan(inactive_at_once)\n",
        "",
        "prove --document edm --quiet ready_is_activate_of_the_same_call",
        2,
        "it proves nothing",
    ),
    Case(
        "a theorem speaks of no scan",
        ROOM,
        "def inactive_at_once(scan: Scanned) -> Obligation:\n",
        "def inactive_at_once(scan: Scanned) -> Obligation:\n    return None\n",
        "prove --document edm --quiet ready_is_activate_of_the_same_call",
        2,
        "it proves nothing",
    ),
    Case(
        "a premise that cannot be met",
        ROOM,
        "    return stopped, z3.Not(scan.sends.S_EDM_Out)",
        "    return FALSE, z3.Not(scan.sends.S_EDM_Out)",
        "prove --document edm --quiet a_stop_request_switches_off_in_its_own_call",
        2,
        "the premises cannot be met",
    ),
    Case(
        "an invariant that no state fulfils",
        "proofs/edm/invariant.py",
        'return s.out_control_before if c == "OutputEnable" else TRUE',
        "return z3.BoolVal(False)",
        "prove --document edm --quiet a_stop_request_switches_off_in_its_own_call",
        2,
        "the premises cannot be met",
    ),
    Case(
        "an invariant that no call keeps",
        "proofs/edm/invariant.py",
        'return s.out_control_before if c == "OutputEnable" else TRUE',
        'return s.stop_seen if c == "OutputDisable" else TRUE',
        "prove --document edm --quiet every_call_keeps_the_invariant",
        1,
        "VIOLATED",
    ),
    Case(
        "a control that cannot fail is no control",
        ROOM,
        "        return scan.inputs.Activate, scan.sends.S_EDM_Out",
        "        return scan.inputs.Activate, TRUE",
        "prove --document edm --quiet ready_is_activate_of_the_same_call",
        2,
        "the example that must exist does not",
    ),
)

EXPLORER = (
    Case(
        "the explorer sees only 0 to 5000 ms",
        "proofs/explorer/device.py",
        '{"dt_ms": number("in.dt_ms", 0), **values}',
        '{"dt_ms": number("in.dt_ms", 0, 5000), **values}',
        "prove --document edm --quiet every_call_takes_exactly_one_path",
        2,
        "the example that must exist does not",
    ),
    Case(
        "the explorer leaves out a control state",
        "proofs/explorer/device.py",
        "for control in device.module.Step)",
        "for control in list(device.module.Step)[1:])",
        "prove --document edm --quiet every_call_takes_exactly_one_path",
        2,
        "the interface has",
    ),
    Case(
        "the explorer sees small numbers only",
        "proofs/explorer/device.py",
        "return number(name, low, high)",
        "return number(name, low, 1000)",
        "prove --document edm --quiet every_call_takes_exactly_one_path",
        2,
        "the example that must exist does not",
    ),
    Case(
        "the explorer sees a flag as FALSE",
        "proofs/explorer/values.py",
        "        return FlagProxy(self.term, run)",
        "        return FlagProxy(z3.BoolVal(False), run)",
        "prove --document edm --quiet ready_is_activate_of_the_same_call",
        1,
        "VIOLATED",
    ),
    Case(
        "the explorer drops every second path",
        "proofs/explorer/explore.py",
        "            waiting += run.branches\n",
        "            waiting += run.branches[::2]\n",
        "prove --document edm --quiet every_call_takes_exactly_one_path",
        1,
        "VIOLATED",
    ),
)

RUNS = "spec/edm/runs.toml"
MODELS = (
    Case(
        "the smallest time only",
        RUNS,
        'MONITORING_TIME = "2"\n',
        'MONITORING_TIME = "0"\n',
        "check MC_SF_EDM_arbitrary --quiet",
        1,
        "NOT edm/MC_SF_EDM_arbitrary",
    ),
    Case(
        "a property is left out of a run",
        RUNS,
        '"OutputNeedsAll", "IdleShowsNothing"',
        '"IdleShowsNothing"',
        "check MC_SF_EDM_arbitrary --quiet",
        1,
        "NOT edm/MC_SF_EDM_arbitrary",
    ),
    Case(
        "a property is taken away again",
        RUNS,
        "counts = [81, 15553]\n\n[run.MC_SF_EDM_cautious]",
        'without = ["StopAtOnce"]\ncounts = [81, 15553]\n\n[run.MC_SF_EDM_cautious]',
        "check MC_SF_EDM_arbitrary --quiet",
        1,
        "NOT edm/MC_SF_EDM_arbitrary",
    ),
    Case(
        "a count is pinned by hand",
        RUNS,
        "counts = [81, 15553]\n\n[run.MC_SF_EDM_cautious]",
        "counts = [80, 15553]\n\n[run.MC_SF_EDM_cautious]",
        "check MC_SF_EDM_arbitrary --quiet",
        1,
        "81",
    ),
    Case(
        "a view that sees less",
        OPEN,
        "ObservedView == <<edm, observer>>",
        "ObservedView == <<state>>",
        "check MC_SF_EDM_arbitrary --quiet",
        1,
        "NOT edm/MC_SF_EDM_arbitrary",
    ),
    Case(
        "an alphabet without one input",
        OPEN,
        "N == 64 * 3",
        "N == 64 * 2",
        "check OPEN_SF_EDM --quiet",
        1,
        "NOT edm/OPEN_SF_EDM",
    ),
    Case(
        "a device that no longer does what its graph says",
        EDM,
        "Requested(i) == i.S_OutControl /\\ stopSeen",
        "Requested(i) == i.S_OutControl",
        "check MC_SF_EDM_cautious --quiet",  # in the letter stopSeen is TRUE wherever this is read
        1,
        "VIOLATED",
    ),
    Case(
        "a negative that names another property",
        RUNS,
        'reading = "RequestBeforeTimeout", property = "CodeNamesTheCause"',
        'reading = "RequestBeforeTimeout", property = "ErrorNeedsCause"',
        "check NEG_SF_EDM_request_before_timeout --quiet",
        1,
        "NOT edm/NEG_SF_EDM_request_before_timeout",
    ),
    Case(
        "a negative with another length",
        RUNS,
        'property = "CodeNamesTheCause", trace_length = 4 }',
        'property = "CodeNamesTheCause", trace_length = 5 }',
        "check NEG_SF_EDM_request_before_timeout --quiet",
        1,
        "NOT edm/NEG_SF_EDM_request_before_timeout",
    ),
    Case(
        "a reading that reads nothing into it",
        "spec/edm/EDMAsPrinted.tla",
        "LateInEnable_StopBeforeTimeout(i) == Expired(i) /\\ ~Feedback(i, FALSE) /\\ i.S_OutControl",
        "LateInEnable_StopBeforeTimeout(i) == Expired(i) /\\ ~Feedback(i, FALSE)",
        "check NEG_SF_EDM_stop_before_timeout --quiet",
        1,
        "NOT edm/NEG_SF_EDM_stop_before_timeout",
    ),
    Case(
        "a witness that no step reaches",
        RUNS,
        'witnesses = [\n    "Deactivate", ',
        'witnesses = [\n    "Deactivated", "Deactivate", ',
        "check WIT_SF_EDM --quiet",
        1,
        "UNREACHED",
    ),
    Case(
        "a fair machine is not asked for",
        "spec/edm/EDMLive.tla",
        "    /\\ WF_<<liveVars, step>>(CalmCall)\n",
        "",
        "check LIVE_SF_EDM_recovery --quiet",
        1,
        "VIOLATED",
    ),
)

PROPS, PINS = "spec/edm/properties.toml", "spec/edm/pins.toml"


def register(name: str, file: str, old: str, new: str | None, of: str, status: int = 1) -> Case:
    """A register is changed: the registers of the document notice."""
    return Case(name, file, old, new, f"stage {file.split('/')[1].removesuffix('.md')}", status, of)


REGISTERS = (
    register("the pins are gone", PINS, "", None, "is not pinned"),
    register(
        "a pin is taken out",
        PINS,
        'ResetsAtOnce = "',
        'Another = "',
        "checked.ResetsAtOnce: is not pinned",
    ),
    register(
        "a pin is changed",
        PINS,
        'ResetsAtOnce = "',
        'ResetsAtOnce = "0000000000000000"\nStopped = "',
        PINNED,
    ),
    register("pins of another document", PINS, 'document = "edm"', 'document = "edm2"', "is another's"),
    register(
        "a property without a row", PROPS, "[property.StopAtOnce]", "[property.StopsAtOnce]", "StopsAtOnce"
    ),
    register(
        "an antecedent that no run reaches",
        PROPS,
        'antecedent = "Deactivate"',
        'antecedent = "Deactivated"',
        "'Deactivated'",
    ),
    register(
        "no antecedent and no reason",
        PROPS,
        'antecedent = "Deactivate"',
        'antecedent = ""',
        "names no antecedent",
    ),
    register(
        "evidence that does not exist",
        "spec/edm/findings.toml",
        'evidence = ["MC_SF_EDM_arbitrary", "WIT_SF_EDM"]',
        'evidence = ["MC_SF_EDM_arbitrary", "WIT_SF_EDMS"]',
        "WIT_SF_EDMS",
    ),
    register(
        "an assumption that nothing explains",
        "spec/edm/assumptions.toml",
        '"every time is a good one for the model; what a time is worth on a machine is outside it"',
        '""',
        "names no run that breaks it",
    ),
    register(
        "a promise in the place of evidence",
        "spec/edm/assumptions.toml",
        "every time is a good one for the model; what a time is worth on a machine is outside it",
        "a run that shows it comes later",
        "promise",
    ),
    register(
        "a property is checked by no run any more",
        RUNS,
        'properties = ["ErrorOutlivesDeactivation"]',
        'properties = ["EDMTypeOK"]',
        "does not check ErrorOutlivesDeactivation",
        2,
    ),
    register(
        "an environment in which nobody checked it",
        PROPS,
        'environments = ["recovering"]',
        'environments = ["honest"]',
        "no run checks it in the environment",
    ),
    register(
        "the page says more than was done",
        "docs/edm.md",
        "complete graphs",
        "complete graphs of all devices",
        "is not what the registers give",
    ),
    register(
        "a clause is cited that does not exist",
        OPEN,
        "\\* EDM-OUT-READY-1\n",
        "\\* EDM-OUT-READY-9\n",
        "EDM-OUT-READY-9",
    ),
    register(
        "a theorem proves a property that does not exist",
        ROOM,
        'properties=["StopAtOnce"]',
        'properties=["StopsAtOnce"]',
        "StopsAtOnce",
    ),
    register(
        "a finding about a reading that no run tries",
        RUNS,
        'NEG_SF_EDM_demands_control_by_edge = { reading = "ControlByEdge"',
        'NEG_SF_EDM_demands_control_by_edge = { reading = "StaticResetIgnored"',
        "ControlByEdge",
    ),
    Case(
        "a published file is not the one that was sealed",
        "vectors/SHA256SUMS",
        "  sf_edm/brief.jsonl.gz",
        "  sf_edm/brief.jsonl.g",
        "registers --document edm",
        1,
        "vectors/sf_edm/brief.jsonl.gz: is not in SHA256SUMS",
    ),
    register(
        "a state has no code",
        "spec/edm/interface.toml",
        'InitError = "C100"\n',
        "",
        "InitError: each state has a code, and no other",
    ),
    register(
        "main runs are moved to the exhaustive lane",
        RUNS,
        "[run.MC_SF_EDM_arbitrary]\n",
        '[run.MC_SF_EDM_arbitrary]\nlanes = ["exhaustive"]\n',
        "lane",
    ),
)

CODE = (
    Case(
        "unsafe code is not published, also not in the vectors of the machine",
        "refimpl/guard_locking/sf_guard_locking.py",
        "if i.UnlockRequest and i.S_SafetyActive:",
        "if i.UnlockRequest:",
        "renew --document guard_locking --quiet",
        1,
        "specification and reference implementation differ",
    ),
    Case(
        "the code ends nothing with Activate",
        "refimpl/edm/sf_edm.py",
        "    elif not inputs.Activate:\n",
        "    elif not inputs.Activate and not inputs.S_OutControl:\n",
        "prove --document edm --quiet ready_is_activate_of_the_same_call",
        1,
        "VIOLATED",
    ),
    Case(
        "the code forgets an edge",
        "refimpl/edm/sf_edm.py",
        "return State(s.params, after, i.Reset, i.S_OutControl, stop_seen, elapsed_ms)",
        "return State(s.params, after, False, i.S_OutControl, stop_seen, elapsed_ms)",
        "prove --document edm --quiet every_call_keeps_the_invariant",
        1,
        "VIOLATED",
    ),
    Case(
        "the code keeps the output on after six seconds",
        "refimpl/edm/sf_edm.py",
        "    elif not inputs.Activate:\n",
        "    elif not inputs.Activate and inputs.dt_ms < 6000:\n",
        "prove --document edm --quiet a_stop_request_switches_off_in_its_own_call",
        1,
        "VIOLATED",
    ),
)
EVERY = (*PROPERTIES, *CONTRACT, *THEOREMS, *EXPLORER, *MODELS, *REGISTERS, *CODE)
