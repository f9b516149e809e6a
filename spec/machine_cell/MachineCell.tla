-------------------- MODULE MachineCell --------------------
\* a machine tool with a locked guard, a loading opening, an enable switch and five modes of safe operation, over the contracts of its blocks.
\* Made by `modeproof machine --model FILE` from a wiring. Our own design: no claim about a paper.
EXTENDS Integers
CONSTANT Words    \* the words that are tried
VARIABLES
    at,        \* the step of the scan that comes next
    broken,    \* what was found broken in the step before
    fplc, guard, beam, enable, edm, LA, S_GuardClosed, S_GuardBolt, UnlockButton, ResetGuard, S_BeamFree, ResetBeam, S_Enable1, S_Enable2, S_Enable3, Reset, S_Standstill, S_Contactor1, S_Contactor2, manual_begins_CLK, manual_begins_Q, automatic_begins_CLK, automatic_begins_Q, setup_begins_CLK, setup_begins_Q, intervention_begins_CLK, intervention_begins_Q, service_begins_CLK, service_begins_Q, slow_move_Q1, reset_edge_CLK, armed_Q1, start_edge_CLK, ready_begins_CLK, running_Q1, held_Q1, desk_reset_CLK, guard_reset_CLK, beam_reset_CLK, start_press_CLK, manual_new_CLK, automatic_new_CLK, setup_new_CLK, intervention_new_CLK, service_new_CLK, nobody_inside_Q1, opening_reset_Q1, drive_starts_CLK, drive_stops_CLK, unlock_begins_CLK, protected_again_CLK, reset_due_Q1, reset_done_CLK, start_due_Q1, moving_Q1, open_three_Q1, open_two_Q1, open_one_Q1, fast_begins_CLK, started_inside_Q1, started_reaching_Q1, moving_inside_Q1, lock_lost_CLK, lamp_explained_Q1, LettingGoStops_waits, LettingGoStopsOpen_waits, SqueezingStops_waits, SqueezingStopsOpen_waits, DoorNeedsReset_waits, DoorErrorStays_waits, BeamErrorStays_waits, SwitchErrorStays_waits, ContactorErrorStays_waits
vars == <<at, broken, fplc, guard, beam, enable, edm, LA, S_GuardClosed, S_GuardBolt, UnlockButton, ResetGuard, S_BeamFree, ResetBeam, S_Enable1, S_Enable2, S_Enable3, Reset, S_Standstill, S_Contactor1, S_Contactor2, manual_begins_CLK, manual_begins_Q, automatic_begins_CLK, automatic_begins_Q, setup_begins_CLK, setup_begins_Q, intervention_begins_CLK, intervention_begins_Q, service_begins_CLK, service_begins_Q, slow_move_Q1, reset_edge_CLK, armed_Q1, start_edge_CLK, ready_begins_CLK, running_Q1, held_Q1, desk_reset_CLK, guard_reset_CLK, beam_reset_CLK, start_press_CLK, manual_new_CLK, automatic_new_CLK, setup_new_CLK, intervention_new_CLK, service_new_CLK, nobody_inside_Q1, opening_reset_Q1, drive_starts_CLK, drive_stops_CLK, unlock_begins_CLK, protected_again_CLK, reset_due_Q1, reset_done_CLK, start_due_Q1, moving_Q1, open_three_Q1, open_two_Q1, open_one_Q1, fast_begins_CLK, started_inside_Q1, started_reaching_Q1, moving_inside_Q1, lock_lost_CLK, lamp_explained_Q1, LettingGoStops_waits, LettingGoStopsOpen_waits, SqueezingStops_waits, SqueezingStopsOpen_waits, DoorNeedsReset_waits, DoorErrorStays_waits, BeamErrorStays_waits, SwitchErrorStays_waits, ContactorErrorStays_waits>>
fplc_is == INSTANCE FPLCContract
guard_is == INSTANCE GuardContract
beam_is == INSTANCE BeamContract
enable_is == INSTANCE SwitchContract
edm_is == INSTANCE ContactorContract

Init ==
    /\ at = 1 /\ broken = {}
    /\ fplc = fplc_is!Start
    /\ guard = guard_is!Start
    /\ beam = beam_is!Start
    /\ enable = enable_is!Start
    /\ edm = edm_is!Start
    /\ LA = FALSE
    /\ S_GuardClosed = FALSE
    /\ S_GuardBolt = FALSE
    /\ UnlockButton = FALSE
    /\ ResetGuard = FALSE
    /\ S_BeamFree = FALSE
    /\ ResetBeam = FALSE
    /\ S_Enable1 = FALSE
    /\ S_Enable2 = FALSE
    /\ S_Enable3 = FALSE
    /\ Reset = FALSE
    /\ S_Standstill = FALSE
    /\ S_Contactor1 = FALSE
    /\ S_Contactor2 = FALSE
    /\ manual_begins_CLK = FALSE
    /\ manual_begins_Q = FALSE
    /\ automatic_begins_CLK = FALSE
    /\ automatic_begins_Q = FALSE
    /\ setup_begins_CLK = FALSE
    /\ setup_begins_Q = FALSE
    /\ intervention_begins_CLK = FALSE
    /\ intervention_begins_Q = FALSE
    /\ service_begins_CLK = FALSE
    /\ service_begins_Q = FALSE
    /\ slow_move_Q1 = FALSE
    /\ reset_edge_CLK = FALSE
    /\ armed_Q1 = FALSE
    /\ start_edge_CLK = FALSE
    /\ ready_begins_CLK = FALSE
    /\ running_Q1 = FALSE
    /\ held_Q1 = FALSE
    /\ desk_reset_CLK = FALSE
    /\ guard_reset_CLK = FALSE
    /\ beam_reset_CLK = FALSE
    /\ start_press_CLK = FALSE
    /\ manual_new_CLK = FALSE
    /\ automatic_new_CLK = FALSE
    /\ setup_new_CLK = FALSE
    /\ intervention_new_CLK = FALSE
    /\ service_new_CLK = FALSE
    /\ nobody_inside_Q1 = FALSE
    /\ opening_reset_Q1 = FALSE
    /\ drive_starts_CLK = FALSE
    /\ drive_stops_CLK = FALSE
    /\ unlock_begins_CLK = FALSE
    /\ protected_again_CLK = FALSE
    /\ reset_due_Q1 = FALSE
    /\ reset_done_CLK = FALSE
    /\ start_due_Q1 = FALSE
    /\ moving_Q1 = FALSE
    /\ open_three_Q1 = FALSE
    /\ open_two_Q1 = FALSE
    /\ open_one_Q1 = FALSE
    /\ fast_begins_CLK = FALSE
    /\ started_inside_Q1 = FALSE
    /\ started_reaching_Q1 = FALSE
    /\ moving_inside_Q1 = FALSE
    /\ lock_lost_CLK = FALSE
    /\ lamp_explained_Q1 = FALSE
    /\ LettingGoStops_waits = FALSE
    /\ LettingGoStopsOpen_waits = FALSE
    /\ SqueezingStops_waits = FALSE
    /\ SqueezingStopsOpen_waits = FALSE
    /\ DoorNeedsReset_waits = FALSE
    /\ DoorErrorStays_waits = FALSE
    /\ BeamErrorStays_waits = FALSE
    /\ SwitchErrorStays_waits = FALSE
    /\ ContactorErrorStays_waits = FALSE

Step1 ==
    /\ at = 1 /\ at' = 2
    /\ \E new_LA \in BOOLEAN :
       \E i \in {[LA |-> new_LA]} :
       /\ \E row \in fplc_is!Rows :
             fplc_is!Guarantees(fplc, i, row) /\ fplc' = row
       /\ broken' = IF fplc_is!Assumes(fplc, i) THEN {} ELSE {"fplc"}
       /\ LA' = new_LA
       /\ UNCHANGED <<guard, beam, enable, edm, S_GuardClosed, S_GuardBolt, UnlockButton, ResetGuard, S_BeamFree, ResetBeam, S_Enable1, S_Enable2, S_Enable3, Reset, S_Standstill, S_Contactor1, S_Contactor2, manual_begins_CLK, manual_begins_Q, automatic_begins_CLK, automatic_begins_Q, setup_begins_CLK, setup_begins_Q, intervention_begins_CLK, intervention_begins_Q, service_begins_CLK, service_begins_Q, slow_move_Q1, reset_edge_CLK, armed_Q1, start_edge_CLK, ready_begins_CLK, running_Q1, held_Q1, desk_reset_CLK, guard_reset_CLK, beam_reset_CLK, start_press_CLK, manual_new_CLK, automatic_new_CLK, setup_new_CLK, intervention_new_CLK, service_new_CLK, nobody_inside_Q1, opening_reset_Q1, drive_starts_CLK, drive_stops_CLK, unlock_begins_CLK, protected_again_CLK, reset_due_Q1, reset_done_CLK, start_due_Q1, moving_Q1, open_three_Q1, open_two_Q1, open_one_Q1, fast_begins_CLK, started_inside_Q1, started_reaching_Q1, moving_inside_Q1, lock_lost_CLK, lamp_explained_Q1, LettingGoStops_waits, LettingGoStopsOpen_waits, SqueezingStops_waits, SqueezingStopsOpen_waits, DoorNeedsReset_waits, DoorErrorStays_waits, BeamErrorStays_waits, SwitchErrorStays_waits, ContactorErrorStays_waits>>

Step2 ==
    /\ at = 2 /\ at' = 3
    /\ \E new_S_Standstill \in BOOLEAN, new_S_Contactor1 \in BOOLEAN, new_S_Contactor2 \in BOOLEAN, new_S_GuardClosed \in BOOLEAN, new_UnlockButton \in BOOLEAN, new_S_GuardBolt \in BOOLEAN, new_ResetGuard \in BOOLEAN :
       \E new_manual_begins_CLK \in {fplc.MSO_0} :
       \E new_manual_begins_Q \in {new_manual_begins_CLK /\ ~manual_begins_CLK} :
       \E new_automatic_begins_CLK \in {fplc.MSO_1} :
       \E new_automatic_begins_Q \in {new_automatic_begins_CLK /\ ~automatic_begins_CLK} :
       \E new_setup_begins_CLK \in {fplc.MSO_2} :
       \E new_setup_begins_Q \in {new_setup_begins_CLK /\ ~setup_begins_CLK} :
       \E new_intervention_begins_CLK \in {fplc.MSO_3} :
       \E new_intervention_begins_Q \in {new_intervention_begins_CLK /\ ~intervention_begins_CLK} :
       \E new_service_begins_CLK \in {fplc.MSO_4} :
       \E new_service_begins_Q \in {new_service_begins_CLK /\ ~service_begins_CLK} :
       \E at_rest \in {(((new_S_Standstill /\ new_S_Contactor1) /\ new_S_Contactor2) /\ ~edm.S_EDM_Out)} :
       \E new_slow_move_Q1 \in {~at_rest /\ ((held_Q1 /\ edm.S_EDM_Out) \/ slow_move_Q1)} :
       \E zone_safe \in {(at_rest \/ (new_slow_move_Q1 /\ ~new_UnlockButton))} :
       \E i \in {[Activate |-> TRUE, S_GuardMonitoring |-> new_S_GuardClosed, S_SafetyActive |-> zone_safe, S_GuardLock |-> new_S_GuardBolt, UnlockRequest |-> new_UnlockButton, S_StartReset |-> FALSE, S_AutoReset |-> FALSE, Reset |-> new_ResetGuard]} :
       /\ \E row \in guard_is!Rows :
             guard_is!Guarantees(guard, i, row) /\ guard' = row
       /\ broken' = IF guard_is!Assumes(guard, i) THEN {} ELSE {"guard"}
       /\ manual_begins_CLK' = new_manual_begins_CLK
       /\ manual_begins_Q' = new_manual_begins_Q
       /\ automatic_begins_CLK' = new_automatic_begins_CLK
       /\ automatic_begins_Q' = new_automatic_begins_Q
       /\ setup_begins_CLK' = new_setup_begins_CLK
       /\ setup_begins_Q' = new_setup_begins_Q
       /\ intervention_begins_CLK' = new_intervention_begins_CLK
       /\ intervention_begins_Q' = new_intervention_begins_Q
       /\ service_begins_CLK' = new_service_begins_CLK
       /\ service_begins_Q' = new_service_begins_Q
       /\ slow_move_Q1' = new_slow_move_Q1
       /\ S_Standstill' = new_S_Standstill
       /\ S_Contactor1' = new_S_Contactor1
       /\ S_Contactor2' = new_S_Contactor2
       /\ S_GuardClosed' = new_S_GuardClosed
       /\ UnlockButton' = new_UnlockButton
       /\ S_GuardBolt' = new_S_GuardBolt
       /\ ResetGuard' = new_ResetGuard
       /\ UNCHANGED <<fplc, beam, enable, edm, LA, S_BeamFree, ResetBeam, S_Enable1, S_Enable2, S_Enable3, Reset, reset_edge_CLK, armed_Q1, start_edge_CLK, ready_begins_CLK, running_Q1, held_Q1, desk_reset_CLK, guard_reset_CLK, beam_reset_CLK, start_press_CLK, manual_new_CLK, automatic_new_CLK, setup_new_CLK, intervention_new_CLK, service_new_CLK, nobody_inside_Q1, opening_reset_Q1, drive_starts_CLK, drive_stops_CLK, unlock_begins_CLK, protected_again_CLK, reset_due_Q1, reset_done_CLK, start_due_Q1, moving_Q1, open_three_Q1, open_two_Q1, open_one_Q1, fast_begins_CLK, started_inside_Q1, started_reaching_Q1, moving_inside_Q1, lock_lost_CLK, lamp_explained_Q1, LettingGoStops_waits, LettingGoStopsOpen_waits, SqueezingStops_waits, SqueezingStopsOpen_waits, DoorNeedsReset_waits, DoorErrorStays_waits, BeamErrorStays_waits, SwitchErrorStays_waits, ContactorErrorStays_waits>>

Step3 ==
    /\ at = 3 /\ at' = 4
    /\ \E new_S_BeamFree \in BOOLEAN, new_BeamTest \in BOOLEAN, new_ResetBeam \in BOOLEAN :
       \E i \in {[Activate |-> TRUE, S_OSSD_In |-> new_S_BeamFree, StartTest |-> new_BeamTest, NoExternalTest |-> TRUE, S_StartReset |-> FALSE, S_AutoReset |-> FALSE, Reset |-> new_ResetBeam]} :
       /\ \E row \in beam_is!Rows :
             beam_is!Guarantees(beam, i, row) /\ beam' = row
       /\ broken' = IF beam_is!Assumes(beam, i) THEN {} ELSE {"beam"}
       /\ S_BeamFree' = new_S_BeamFree
       /\ ResetBeam' = new_ResetBeam
       /\ UNCHANGED <<fplc, guard, enable, edm, LA, S_GuardClosed, S_GuardBolt, UnlockButton, ResetGuard, S_Enable1, S_Enable2, S_Enable3, Reset, S_Standstill, S_Contactor1, S_Contactor2, manual_begins_CLK, manual_begins_Q, automatic_begins_CLK, automatic_begins_Q, setup_begins_CLK, setup_begins_Q, intervention_begins_CLK, intervention_begins_Q, service_begins_CLK, service_begins_Q, slow_move_Q1, reset_edge_CLK, armed_Q1, start_edge_CLK, ready_begins_CLK, running_Q1, held_Q1, desk_reset_CLK, guard_reset_CLK, beam_reset_CLK, start_press_CLK, manual_new_CLK, automatic_new_CLK, setup_new_CLK, intervention_new_CLK, service_new_CLK, nobody_inside_Q1, opening_reset_Q1, drive_starts_CLK, drive_stops_CLK, unlock_begins_CLK, protected_again_CLK, reset_due_Q1, reset_done_CLK, start_due_Q1, moving_Q1, open_three_Q1, open_two_Q1, open_one_Q1, fast_begins_CLK, started_inside_Q1, started_reaching_Q1, moving_inside_Q1, lock_lost_CLK, lamp_explained_Q1, LettingGoStops_waits, LettingGoStopsOpen_waits, SqueezingStops_waits, SqueezingStopsOpen_waits, DoorNeedsReset_waits, DoorErrorStays_waits, BeamErrorStays_waits, SwitchErrorStays_waits, ContactorErrorStays_waits>>

Step4 ==
    /\ at = 4 /\ at' = 5
    /\ \E new_S_Enable1 \in BOOLEAN, new_S_Enable2 \in BOOLEAN, new_S_Enable3 \in BOOLEAN, new_Reset \in BOOLEAN :
       \E manual \in {fplc.MSO_0} :
       \E setup \in {fplc.MSO_2} :
       \E intervention \in {fplc.MSO_3} :
       \E service \in {fplc.MSO_4} :
       \E enable_in_use \in {(((manual \/ setup) \/ intervention) \/ service)} :
       \E i \in {[Activate |-> TRUE, S_SafetyActive |-> enable_in_use, S_EnableSwitchCh1 |-> new_S_Enable1, S_EnableSwitchCh2 |-> new_S_Enable2, S_EnableSwitchCh3 |-> new_S_Enable3, S_AutoReset |-> FALSE, Reset |-> new_Reset]} :
       /\ \E row \in enable_is!Rows :
             enable_is!Guarantees(enable, i, row) /\ enable' = row
       /\ broken' = IF enable_is!Assumes(enable, i) THEN {} ELSE {"enable"}
       /\ S_Enable1' = new_S_Enable1
       /\ S_Enable2' = new_S_Enable2
       /\ S_Enable3' = new_S_Enable3
       /\ Reset' = new_Reset
       /\ UNCHANGED <<fplc, guard, beam, edm, LA, S_GuardClosed, S_GuardBolt, UnlockButton, ResetGuard, S_BeamFree, ResetBeam, S_Standstill, S_Contactor1, S_Contactor2, manual_begins_CLK, manual_begins_Q, automatic_begins_CLK, automatic_begins_Q, setup_begins_CLK, setup_begins_Q, intervention_begins_CLK, intervention_begins_Q, service_begins_CLK, service_begins_Q, slow_move_Q1, reset_edge_CLK, armed_Q1, start_edge_CLK, ready_begins_CLK, running_Q1, held_Q1, desk_reset_CLK, guard_reset_CLK, beam_reset_CLK, start_press_CLK, manual_new_CLK, automatic_new_CLK, setup_new_CLK, intervention_new_CLK, service_new_CLK, nobody_inside_Q1, opening_reset_Q1, drive_starts_CLK, drive_stops_CLK, unlock_begins_CLK, protected_again_CLK, reset_due_Q1, reset_done_CLK, start_due_Q1, moving_Q1, open_three_Q1, open_two_Q1, open_one_Q1, fast_begins_CLK, started_inside_Q1, started_reaching_Q1, moving_inside_Q1, lock_lost_CLK, lamp_explained_Q1, LettingGoStops_waits, LettingGoStopsOpen_waits, SqueezingStops_waits, SqueezingStopsOpen_waits, DoorNeedsReset_waits, DoorErrorStays_waits, BeamErrorStays_waits, SwitchErrorStays_waits, ContactorErrorStays_waits>>

Step5 ==
    /\ at = 5 /\ at' = 1
    /\ \E new_S_EmergencyStop \in BOOLEAN, new_Start \in BOOLEAN, new_Stop \in BOOLEAN, new_STR \in BOOLEAN, new_D \in BOOLEAN, new_C \in BOOLEAN, new_B \in BOOLEAN, new_A \in BOOLEAN :
       \E new_reset_edge_CLK \in {Reset} :
       \E new_reset_edge_Q \in {new_reset_edge_CLK /\ ~reset_edge_CLK} :
       \E manual \in {fplc.MSO_0} :
       \E automatic \in {fplc.MSO_1} :
       \E setup \in {fplc.MSO_2} :
       \E intervention \in {fplc.MSO_3} :
       \E service \in {fplc.MSO_4} :
       \E a_mode \in {((((manual \/ automatic) \/ setup) \/ intervention) \/ service)} :
       \E mode_changes \in {((((manual_begins_Q \/ automatic_begins_Q) \/ setup_begins_Q) \/ intervention_begins_Q) \/ service_begins_Q)} :
       \E fault \in {(edm.Error \/ fplc.ERROR)} :
       \E new_armed_Q1 \in {~(((~a_mode \/ mode_changes) \/ fault) \/ ~new_S_EmergencyStop) /\ (new_reset_edge_Q \/ armed_Q1)} :
       \E new_start_edge_CLK \in {new_Start} :
       \E new_start_edge_Q \in {new_start_edge_CLK /\ ~start_edge_CLK} :
       \E safeguards_hold \in {(((((manual /\ ((guard.S_GuardLocked /\ beam.S_OSSD_Out) \/ enable.S_EnableSwitchOut)) \/ (automatic /\ (guard.S_GuardLocked /\ beam.S_OSSD_Out))) \/ (setup /\ enable.S_EnableSwitchOut)) \/ (intervention /\ ((guard.S_GuardLocked /\ beam.S_OSSD_Out) \/ (enable.S_EnableSwitchOut /\ beam.S_OSSD_Out)))) \/ (service /\ (enable.S_EnableSwitchOut /\ beam.S_OSSD_Out)))} :
       \E ready \in {((new_armed_Q1 /\ safeguards_hold) /\ new_Stop)} :
       \E new_ready_begins_CLK \in {ready} :
       \E new_ready_begins_Q \in {new_ready_begins_CLK /\ ~ready_begins_CLK} :
       \E starts \in {((((new_start_edge_Q /\ ready) /\ ~new_ready_begins_Q) /\ S_Standstill) /\ ~edm.S_EDM_Out)} :
       \E new_running_Q1 \in {~(~ready \/ enable.S_EnableSwitchOut) /\ (starts \/ running_Q1)} :
       \E new_held_Q1 \in {~(~ready \/ ~enable.S_EnableSwitchOut) /\ (starts \/ held_Q1)} :
       \E i \in {[Activate |-> TRUE, S_OutControl |-> (new_running_Q1 \/ new_held_Q1), S_EDM1 |-> S_Contactor1, S_EDM2 |-> S_Contactor2, S_StartReset |-> FALSE, Reset |-> Reset]} :
       /\ \E row \in edm_is!Rows :
             edm_is!Guarantees(edm, i, row) /\ edm' = row
       /\ \E new_desk_reset_Q \in {new_reset_edge_CLK /\ ~desk_reset_CLK} :
          \E new_guard_reset_CLK \in {ResetGuard} :
          \E new_guard_reset_Q \in {new_guard_reset_CLK /\ ~guard_reset_CLK} :
          \E new_beam_reset_CLK \in {ResetBeam} :
          \E new_beam_reset_Q \in {new_beam_reset_CLK /\ ~beam_reset_CLK} :
          \E new_start_press_Q \in {new_start_edge_CLK /\ ~start_press_CLK} :
          \E new_manual_new_CLK \in {manual} :
          \E new_manual_new_Q \in {new_manual_new_CLK /\ ~manual_new_CLK} :
          \E new_automatic_new_CLK \in {automatic} :
          \E new_automatic_new_Q \in {new_automatic_new_CLK /\ ~automatic_new_CLK} :
          \E new_setup_new_CLK \in {setup} :
          \E new_setup_new_Q \in {new_setup_new_CLK /\ ~setup_new_CLK} :
          \E new_intervention_new_CLK \in {intervention} :
          \E new_intervention_new_Q \in {new_intervention_new_CLK /\ ~intervention_new_CLK} :
          \E new_service_new_CLK \in {service} :
          \E new_service_new_Q \in {new_service_new_CLK /\ ~service_new_CLK} :
          \E new_nobody_inside_Q1 \in {~~(S_GuardClosed /\ S_GuardBolt) /\ (((new_guard_reset_Q /\ S_GuardClosed) /\ S_GuardBolt) \/ nobody_inside_Q1)} :
          \E new_opening_reset_Q1 \in {~(~S_BeamFree /\ ~beam.S_OSSD_Out) /\ (new_beam_reset_Q \/ opening_reset_Q1)} :
          \E S_DriveEnable \in {(edm').S_EDM_Out} :
          \E new_drive_starts_CLK \in {S_DriveEnable} :
          \E new_drive_starts_Q \in {new_drive_starts_CLK /\ ~drive_starts_CLK} :
          \E new_drive_stops_Q \in {drive_stops_CLK /\ ~new_drive_starts_CLK} :
          \E S_UnlockGuard \in {guard.S_UnlockGuard} :
          \E new_unlock_begins_CLK \in {S_UnlockGuard} :
          \E new_unlock_begins_Q \in {new_unlock_begins_CLK /\ ~unlock_begins_CLK} :
          \E new_protected_again_CLK \in {safeguards_hold} :
          \E new_protected_again_Q \in {new_protected_again_CLK /\ ~protected_again_CLK} :
          \E new_reset_due_Q1 \in {((((((((~a_mode \/ new_manual_new_Q) \/ new_automatic_new_Q) \/ new_setup_new_Q) \/ new_intervention_new_Q) \/ new_service_new_Q) \/ (edm').Error) \/ fplc.ERROR) \/ ~new_S_EmergencyStop) \/ (reset_due_Q1 /\ ~new_desk_reset_Q)} :
          \E new_reset_done_CLK \in {new_reset_due_Q1} :
          \E new_reset_done_Q \in {reset_done_CLK /\ ~new_reset_done_CLK} :
          \E new_start_due_Q1 \in {((((new_reset_due_Q1 \/ new_reset_done_Q) \/ ~safeguards_hold) \/ new_protected_again_Q) \/ ~new_Stop) \/ (start_due_Q1 /\ ~new_start_press_Q)} :
          \E new_moving_Q1 \in {S_DriveEnable \/ (moving_Q1 /\ ~(((S_Standstill /\ S_Contactor1) /\ S_Contactor2) /\ ~new_drive_stops_Q))} :
          \E new_open_three_Q1 \in {~((S_GuardClosed /\ S_GuardBolt) \/ ResetGuard) /\ (open_two_Q1 \/ open_three_Q1)} :
          \E new_open_two_Q1 \in {~((S_GuardClosed /\ S_GuardBolt) \/ ResetGuard) /\ (open_one_Q1 \/ open_two_Q1)} :
          \E new_open_one_Q1 \in {~((S_GuardClosed /\ S_GuardBolt) \/ ResetGuard) /\ (TRUE \/ open_one_Q1)} :
          \E S_FullSpeed \in {new_running_Q1} :
          \E new_fast_begins_CLK \in {S_FullSpeed} :
          \E new_fast_begins_Q \in {new_fast_begins_CLK /\ ~fast_begins_CLK} :
          \E new_started_inside_Q1 \in {(new_drive_starts_Q /\ ~new_nobody_inside_Q1) \/ (started_inside_Q1 /\ ~~S_DriveEnable)} :
          \E new_started_reaching_Q1 \in {(new_drive_starts_Q /\ ~new_opening_reset_Q1) \/ (started_reaching_Q1 /\ ~~S_DriveEnable)} :
          \E new_moving_inside_Q1 \in {new_started_inside_Q1 \/ (moving_inside_Q1 /\ ~(((S_Standstill /\ S_Contactor1) /\ S_Contactor2) /\ ~new_drive_stops_Q))} :
          \E new_lock_lost_CLK \in {guard.S_GuardLocked} :
          \E new_lock_lost_Q \in {lock_lost_CLK /\ ~new_lock_lost_CLK} :
          \E fault_ \in {((edm').Error \/ fplc.ERROR)} :
          \E Lamp \in {(((fault_ \/ guard.Error) \/ beam.Error) \/ enable.Error)} :
          \E new_lamp_explained_Q1 \in {(Lamp /\ ((((((((~new_moving_inside_Q1 \/ new_drive_starts_Q) \/ beam.Error) \/ enable.Error) \/ (edm').Error) \/ fplc.ERROR) \/ ResetGuard) \/ UnlockButton) \/ new_lock_lost_Q)) \/ (lamp_explained_Q1 /\ ~~Lamp)} :
          \E two_modes \in {((((((((((manual /\ automatic) \/ (manual /\ setup)) \/ (manual /\ intervention)) \/ (manual /\ service)) \/ (automatic /\ setup)) \/ (automatic /\ intervention)) \/ (automatic /\ service)) \/ (setup /\ intervention)) \/ (setup /\ service)) \/ (intervention /\ service))} :
          \E bad_OneMode \in {(a_mode /\ ~~two_modes)} :
          \E bad_ModeNeedsKey \in {(((((new_manual_new_Q \/ new_automatic_new_Q) \/ new_setup_new_Q) \/ new_intervention_new_Q) \/ new_service_new_Q) /\ ~LA)} :
          \E bad_ModeWithinLevel \in {(((((new_manual_new_Q \/ new_automatic_new_Q) \/ new_setup_new_Q) \/ new_intervention_new_Q) \/ new_service_new_Q) /\ ~((((new_STR \/ (~service /\ new_D)) \/ (((manual \/ automatic) \/ setup) /\ new_C)) \/ ((manual \/ automatic) /\ new_B)) \/ (manual /\ new_A)))} :
          \E bad_NoModeNoMotion \in {(S_DriveEnable /\ ~a_mode)} :
          \E bad_ModeChangeStops \in {(((((new_manual_new_Q \/ new_automatic_new_Q) \/ new_setup_new_Q) \/ new_intervention_new_Q) \/ new_service_new_Q) /\ ~~S_DriveEnable)} :
          \E bad_KeyErrorStops \in {(S_DriveEnable /\ fplc.ERROR)} :
          \E bad_SafeguardsOfTheMode \in {(S_DriveEnable /\ ~safeguards_hold)} :
          \E bad_AutomaticClosed \in {((S_DriveEnable /\ automatic) /\ ~(S_GuardClosed /\ S_GuardBolt))} :
          \E bad_OpenOnlyHeld \in {((S_DriveEnable /\ ~(S_GuardClosed /\ S_GuardBolt)) /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3))} :
          \E bad_PersonInside \in {((S_DriveEnable /\ ~new_nobody_inside_Q1) /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3))} :
          \E bad_SetupHeld \in {((S_DriveEnable /\ setup) /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3))} :
          \E bad_ServiceHeld \in {((S_DriveEnable /\ service) /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3))} :
          \E bad_ManualProtected \in {((S_DriveEnable /\ manual) /\ ~((S_GuardClosed /\ S_GuardBolt) \/ ((S_Enable1 /\ ~S_Enable2) /\ S_Enable3)))} :
          \E bad_InterventionProtected \in {((S_DriveEnable /\ intervention) /\ ~((S_GuardClosed /\ S_GuardBolt) \/ ((S_Enable1 /\ ~S_Enable2) /\ S_Enable3)))} :
          \E bad_DarkStopsAtOnce \in {(((S_DriveEnable /\ ~S_BeamFree) /\ (((automatic \/ intervention) \/ service) \/ (manual /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3)))) /\ ~(beam.S_OSSD_Out /\ ~beam.TestPossible))} :
          \E S_BeamTestOut \in {beam.S_TestOut} :
          \E bad_SenderOffOnlyTested \in {(~S_BeamTestOut /\ ~(beam.S_OSSD_Out /\ ~beam.TestPossible))} :
          \E bad_OpenIsSlow \in {((S_DriveEnable /\ ~(S_GuardClosed /\ S_GuardBolt)) /\ ~~S_FullSpeed)} :
          \E bad_InsideIsSlow \in {((S_DriveEnable /\ ~new_nobody_inside_Q1) /\ ~~S_FullSpeed)} :
          \E bad_ReachingIsSlow \in {((S_DriveEnable /\ ~new_opening_reset_Q1) /\ ~~S_FullSpeed)} :
          \E bad_SetupIsSlow \in {((S_DriveEnable /\ (setup \/ service)) /\ ~~S_FullSpeed)} :
          \E bad_FastOnlyByStart \in {((new_fast_begins_Q /\ S_DriveEnable) /\ ~new_drive_starts_Q)} :
          \E bad_StopStops \in {(S_DriveEnable /\ ~new_Stop)} :
          \E bad_EmergencyStopStops \in {(S_DriveEnable /\ ~new_S_EmergencyStop)} :
          \E new_LettingGoStops_waits \in {(LettingGoStops_waits \/ (setup /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3))) /\ ~new_start_press_Q} :
          \E bad_LettingGoStops \in {(new_LettingGoStops_waits /\ (S_DriveEnable /\ setup))} :
          \E new_LettingGoStopsOpen_waits \in {(LettingGoStopsOpen_waits \/ (~(S_GuardClosed /\ S_GuardBolt) /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3))) /\ ~new_start_press_Q} :
          \E bad_LettingGoStopsOpen \in {(new_LettingGoStopsOpen_waits /\ (S_DriveEnable /\ ~(S_GuardClosed /\ S_GuardBolt)))} :
          \E bad_LettingGoStopsInside \in {((S_DriveEnable /\ new_started_inside_Q1) /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3))} :
          \E bad_LettingGoStopsReaching \in {((S_DriveEnable /\ new_started_reaching_Q1) /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3))} :
          \E new_SqueezingStops_waits \in {(SqueezingStops_waits \/ (((setup /\ ~S_Enable1) /\ ~S_Enable2) /\ ~S_Enable3)) /\ ~((~S_Enable1 /\ S_Enable2) /\ ~S_Enable3)} :
          \E bad_SqueezingStops \in {(new_SqueezingStops_waits /\ (S_DriveEnable /\ setup))} :
          \E enable_in_use \in {(((manual \/ setup) \/ intervention) \/ service)} :
          \E new_SqueezingStopsOpen_waits \in {(SqueezingStopsOpen_waits \/ (((enable_in_use /\ ~S_Enable1) /\ ~S_Enable2) /\ ~S_Enable3)) /\ ~((~S_Enable1 /\ S_Enable2) /\ ~S_Enable3)} :
          \E bad_SqueezingStopsOpen \in {(new_SqueezingStopsOpen_waits /\ (S_DriveEnable /\ ~(S_GuardClosed /\ S_GuardBolt)))} :
          \E bad_ResetThenStart \in {(S_DriveEnable /\ (new_reset_due_Q1 \/ new_start_due_Q1))} :
          \E new_DoorNeedsReset_waits \in {(DoorNeedsReset_waits \/ ~(S_GuardClosed /\ S_GuardBolt)) /\ ~((new_guard_reset_Q /\ S_GuardClosed) /\ S_GuardBolt)} :
          \E bad_DoorNeedsReset \in {(new_DoorNeedsReset_waits /\ (S_DriveEnable /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3)))} :
          \E bad_BeamNeedsReset \in {((S_DriveEnable /\ (((automatic \/ intervention) \/ service) \/ (manual /\ ~((S_Enable1 /\ ~S_Enable2) /\ S_Enable3)))) /\ ~new_opening_reset_Q1)} :
          \E bad_StuckStart \in {(new_drive_starts_Q /\ ~new_start_press_Q)} :
          \E bad_StandstillThenStart \in {(new_drive_starts_Q /\ ~S_Standstill)} :
          \E bad_ResetNeverStarts \in {(new_drive_starts_Q /\ ~(~new_protected_again_Q /\ ~new_reset_done_Q))} :
          \E bad_UnlockAtRest \in {(new_unlock_begins_Q /\ ~((((S_Standstill /\ S_Contactor1) /\ S_Contactor2) /\ ~new_drive_stops_Q) /\ (~S_DriveEnable \/ (((new_drive_starts_Q /\ S_Enable1) /\ ~S_Enable2) /\ S_Enable3))))} :
          \E bad_LockedInMotion \in {(S_UnlockGuard /\ ~(((S_Standstill /\ S_Contactor1) /\ S_Contactor2) /\ (~S_DriveEnable \/ (new_drive_starts_Q /\ ~automatic))))} :
          \E bad_UnexpectedMovementIsFound \in {(((new_open_three_Q1 /\ ~new_moving_Q1) /\ ~((S_Standstill /\ S_Contactor1) /\ S_Contactor2)) /\ ~Lamp)} :
          \E bad_UnlockHeld \in {(S_UnlockGuard /\ ~UnlockButton)} :
          \E bad_WeldedPreventsStart \in {(new_drive_starts_Q /\ ~(S_Contactor1 /\ S_Contactor2))} :
          \E bad_ContactorErrorStops \in {(S_DriveEnable /\ (edm').Error)} :
          \E new_DoorErrorStays_waits \in {(DoorErrorStays_waits \/ (guard.Error /\ ~ResetGuard)) /\ ~new_guard_reset_Q} :
          \E bad_DoorErrorStays \in {(new_DoorErrorStays_waits /\ ~guard.Error)} :
          \E new_BeamErrorStays_waits \in {(BeamErrorStays_waits \/ (beam.Error /\ ~ResetBeam)) /\ ~new_beam_reset_Q} :
          \E bad_BeamErrorStays \in {(new_BeamErrorStays_waits /\ ~beam.Error)} :
          \E new_SwitchErrorStays_waits \in {(SwitchErrorStays_waits \/ (enable.Error /\ ~Reset)) /\ ~new_desk_reset_Q} :
          \E bad_SwitchErrorStays \in {(new_SwitchErrorStays_waits /\ ~enable.Error)} :
          \E new_ContactorErrorStays_waits \in {(ContactorErrorStays_waits \/ ((edm').Error /\ ~Reset)) /\ ~new_desk_reset_Q} :
          \E bad_ContactorErrorStays \in {(new_ContactorErrorStays_waits /\ ~(edm').Error)} :
          \E bad_ErrorIsShown \in {((((((edm').Error \/ fplc.ERROR) \/ guard.Error) \/ beam.Error) \/ enable.Error) /\ ~Lamp)} :
          \E bad_LampIsAnError \in {((Lamp /\ new_moving_inside_Q1) /\ ~new_lamp_explained_Q1)} :
          /\ broken' = IF edm_is!Assumes(edm, i) THEN (IF bad_OneMode THEN {"one-mode"} ELSE {}) \cup (IF bad_ModeNeedsKey THEN {"mode-needs-key"} ELSE {}) \cup (IF bad_ModeWithinLevel THEN {"mode-within-level"} ELSE {}) \cup (IF bad_NoModeNoMotion THEN {"no-mode-no-motion"} ELSE {}) \cup (IF bad_ModeChangeStops THEN {"mode-change-stops"} ELSE {}) \cup (IF bad_KeyErrorStops THEN {"key-error-stops"} ELSE {}) \cup (IF bad_SafeguardsOfTheMode THEN {"safeguards-of-the-mode"} ELSE {}) \cup (IF bad_AutomaticClosed THEN {"automatic-closed"} ELSE {}) \cup (IF bad_OpenOnlyHeld THEN {"open-only-held"} ELSE {}) \cup (IF bad_PersonInside THEN {"person-inside"} ELSE {}) \cup (IF bad_SetupHeld THEN {"setup-held"} ELSE {}) \cup (IF bad_ServiceHeld THEN {"service-held"} ELSE {}) \cup (IF bad_ManualProtected THEN {"manual-protected"} ELSE {}) \cup (IF bad_InterventionProtected THEN {"intervention-protected"} ELSE {}) \cup (IF bad_DarkStopsAtOnce THEN {"dark-stops-at-once"} ELSE {}) \cup (IF bad_SenderOffOnlyTested THEN {"sender-off-only-tested"} ELSE {}) \cup (IF bad_OpenIsSlow THEN {"open-is-slow"} ELSE {}) \cup (IF bad_InsideIsSlow THEN {"inside-is-slow"} ELSE {}) \cup (IF bad_ReachingIsSlow THEN {"reaching-is-slow"} ELSE {}) \cup (IF bad_SetupIsSlow THEN {"setup-is-slow"} ELSE {}) \cup (IF bad_FastOnlyByStart THEN {"fast-only-by-start"} ELSE {}) \cup (IF bad_StopStops THEN {"stop-stops"} ELSE {}) \cup (IF bad_EmergencyStopStops THEN {"emergency-stop-stops"} ELSE {}) \cup (IF bad_LettingGoStops THEN {"letting-go-stops"} ELSE {}) \cup (IF bad_LettingGoStopsOpen THEN {"letting-go-stops-open"} ELSE {}) \cup (IF bad_LettingGoStopsInside THEN {"letting-go-stops-inside"} ELSE {}) \cup (IF bad_LettingGoStopsReaching THEN {"letting-go-stops-reaching"} ELSE {}) \cup (IF bad_SqueezingStops THEN {"squeezing-stops"} ELSE {}) \cup (IF bad_SqueezingStopsOpen THEN {"squeezing-stops-open"} ELSE {}) \cup (IF bad_ResetThenStart THEN {"reset-then-start"} ELSE {}) \cup (IF bad_DoorNeedsReset THEN {"door-needs-reset"} ELSE {}) \cup (IF bad_BeamNeedsReset THEN {"beam-needs-reset"} ELSE {}) \cup (IF bad_StuckStart THEN {"stuck-start"} ELSE {}) \cup (IF bad_StandstillThenStart THEN {"standstill-then-start"} ELSE {}) \cup (IF bad_ResetNeverStarts THEN {"reset-never-starts"} ELSE {}) \cup (IF bad_UnlockAtRest THEN {"unlock-at-rest"} ELSE {}) \cup (IF bad_LockedInMotion THEN {"locked-in-motion"} ELSE {}) \cup (IF bad_UnexpectedMovementIsFound THEN {"unexpected-movement-is-found"} ELSE {}) \cup (IF bad_UnlockHeld THEN {"unlock-held"} ELSE {}) \cup (IF bad_WeldedPreventsStart THEN {"welded-prevents-start"} ELSE {}) \cup (IF bad_ContactorErrorStops THEN {"contactor-error-stops"} ELSE {}) \cup (IF bad_DoorErrorStays THEN {"door-error-stays"} ELSE {}) \cup (IF bad_BeamErrorStays THEN {"beam-error-stays"} ELSE {}) \cup (IF bad_SwitchErrorStays THEN {"switch-error-stays"} ELSE {}) \cup (IF bad_ContactorErrorStays THEN {"contactor-error-stays"} ELSE {}) \cup (IF bad_ErrorIsShown THEN {"error-is-shown"} ELSE {}) \cup (IF bad_LampIsAnError THEN {"lamp-is-an-error"} ELSE {}) ELSE {"edm"}
          /\ reset_edge_CLK' = new_reset_edge_CLK
          /\ armed_Q1' = new_armed_Q1
          /\ start_edge_CLK' = new_start_edge_CLK
          /\ ready_begins_CLK' = new_ready_begins_CLK
          /\ running_Q1' = new_running_Q1
          /\ held_Q1' = new_held_Q1
          /\ desk_reset_CLK' = new_reset_edge_CLK
          /\ guard_reset_CLK' = new_guard_reset_CLK
          /\ beam_reset_CLK' = new_beam_reset_CLK
          /\ start_press_CLK' = new_start_edge_CLK
          /\ manual_new_CLK' = new_manual_new_CLK
          /\ automatic_new_CLK' = new_automatic_new_CLK
          /\ setup_new_CLK' = new_setup_new_CLK
          /\ intervention_new_CLK' = new_intervention_new_CLK
          /\ service_new_CLK' = new_service_new_CLK
          /\ nobody_inside_Q1' = new_nobody_inside_Q1
          /\ opening_reset_Q1' = new_opening_reset_Q1
          /\ drive_starts_CLK' = new_drive_starts_CLK
          /\ drive_stops_CLK' = new_drive_starts_CLK
          /\ unlock_begins_CLK' = new_unlock_begins_CLK
          /\ protected_again_CLK' = new_protected_again_CLK
          /\ reset_due_Q1' = new_reset_due_Q1
          /\ reset_done_CLK' = new_reset_done_CLK
          /\ start_due_Q1' = new_start_due_Q1
          /\ moving_Q1' = new_moving_Q1
          /\ open_three_Q1' = new_open_three_Q1
          /\ open_two_Q1' = new_open_two_Q1
          /\ open_one_Q1' = new_open_one_Q1
          /\ fast_begins_CLK' = new_fast_begins_CLK
          /\ started_inside_Q1' = new_started_inside_Q1
          /\ started_reaching_Q1' = new_started_reaching_Q1
          /\ moving_inside_Q1' = new_moving_inside_Q1
          /\ lock_lost_CLK' = new_lock_lost_CLK
          /\ lamp_explained_Q1' = new_lamp_explained_Q1
          /\ LettingGoStops_waits' = new_LettingGoStops_waits
          /\ LettingGoStopsOpen_waits' = new_LettingGoStopsOpen_waits
          /\ SqueezingStops_waits' = new_SqueezingStops_waits
          /\ SqueezingStopsOpen_waits' = new_SqueezingStopsOpen_waits
          /\ DoorNeedsReset_waits' = new_DoorNeedsReset_waits
          /\ DoorErrorStays_waits' = new_DoorErrorStays_waits
          /\ BeamErrorStays_waits' = new_BeamErrorStays_waits
          /\ SwitchErrorStays_waits' = new_SwitchErrorStays_waits
          /\ ContactorErrorStays_waits' = new_ContactorErrorStays_waits
          /\ LA' = FALSE
          /\ S_GuardClosed' = FALSE
          /\ S_GuardBolt' = FALSE
          /\ UnlockButton' = FALSE
          /\ ResetGuard' = FALSE
          /\ S_BeamFree' = FALSE
          /\ ResetBeam' = FALSE
          /\ S_Enable1' = FALSE
          /\ S_Enable2' = FALSE
          /\ S_Enable3' = FALSE
          /\ Reset' = FALSE
          /\ S_Standstill' = FALSE
          /\ S_Contactor1' = FALSE
          /\ S_Contactor2' = FALSE
          /\ manual_begins_Q' = FALSE
          /\ automatic_begins_Q' = FALSE
          /\ setup_begins_Q' = FALSE
          /\ intervention_begins_Q' = FALSE
          /\ service_begins_Q' = FALSE
          /\ UNCHANGED <<fplc, guard, beam, enable, manual_begins_CLK, automatic_begins_CLK, setup_begins_CLK, intervention_begins_CLK, service_begins_CLK, slow_move_Q1>>

Next == Step1 \/ Step2 \/ Step3 \/ Step4 \/ Step5
Spec == Init /\ [][Next]_vars

\* What each contract assumes is true wherever the block is called
Assumes_fplc == "fplc" \notin broken
Assumes_guard == "guard" \notin broken
Assumes_beam == "beam" \notin broken
Assumes_enable == "enable" \notin broken
Assumes_edm == "edm" \notin broken
OneMode == "one-mode" \notin broken
ModeNeedsKey == "mode-needs-key" \notin broken
ModeWithinLevel == "mode-within-level" \notin broken
NoModeNoMotion == "no-mode-no-motion" \notin broken
ModeChangeStops == "mode-change-stops" \notin broken
KeyErrorStops == "key-error-stops" \notin broken
SafeguardsOfTheMode == "safeguards-of-the-mode" \notin broken
AutomaticClosed == "automatic-closed" \notin broken
OpenOnlyHeld == "open-only-held" \notin broken
PersonInside == "person-inside" \notin broken
SetupHeld == "setup-held" \notin broken
ServiceHeld == "service-held" \notin broken
ManualProtected == "manual-protected" \notin broken
InterventionProtected == "intervention-protected" \notin broken
DarkStopsAtOnce == "dark-stops-at-once" \notin broken
SenderOffOnlyTested == "sender-off-only-tested" \notin broken
OpenIsSlow == "open-is-slow" \notin broken
InsideIsSlow == "inside-is-slow" \notin broken
ReachingIsSlow == "reaching-is-slow" \notin broken
SetupIsSlow == "setup-is-slow" \notin broken
FastOnlyByStart == "fast-only-by-start" \notin broken
StopStops == "stop-stops" \notin broken
EmergencyStopStops == "emergency-stop-stops" \notin broken
LettingGoStops == "letting-go-stops" \notin broken
LettingGoStopsOpen == "letting-go-stops-open" \notin broken
LettingGoStopsInside == "letting-go-stops-inside" \notin broken
LettingGoStopsReaching == "letting-go-stops-reaching" \notin broken
SqueezingStops == "squeezing-stops" \notin broken
SqueezingStopsOpen == "squeezing-stops-open" \notin broken
ResetThenStart == "reset-then-start" \notin broken
DoorNeedsReset == "door-needs-reset" \notin broken
BeamNeedsReset == "beam-needs-reset" \notin broken
StuckStart == "stuck-start" \notin broken
StandstillThenStart == "standstill-then-start" \notin broken
ResetNeverStarts == "reset-never-starts" \notin broken
UnlockAtRest == "unlock-at-rest" \notin broken
LockedInMotion == "locked-in-motion" \notin broken
UnexpectedMovementIsFound == "unexpected-movement-is-found" \notin broken
UnlockHeld == "unlock-held" \notin broken
WeldedPreventsStart == "welded-prevents-start" \notin broken
ContactorErrorStops == "contactor-error-stops" \notin broken
DoorErrorStays == "door-error-stays" \notin broken
BeamErrorStays == "beam-error-stays" \notin broken
SwitchErrorStays == "switch-error-stays" \notin broken
ContactorErrorStays == "contactor-error-stays" \notin broken
ErrorIsShown == "error-is-shown" \notin broken
LampIsAnError == "lamp-is-an-error" \notin broken
=============================================================================
